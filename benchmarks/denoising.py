"""What denoising is worth: relMSE before and after on the six scenes, as the table of docs/denoising.md.

python -m benchmarks.denoising
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import etendue
from etendue.denoise import denoise_film

SCENES = ("box", "pots", "sibenik", "spz", "fireplace", "mis")
CONFIGS = Path(__file__).resolve().parent.parent / "configs"
SIZE = 192, 144
SPP, REFERENCE_SPP = 32, 128
# The share of pixels left out, those where the references differ most: one firefly could be the whole of a mean.
OUTLIERS = 0.001

Image = NDArray[np.float32]


def rel_mse(image: Image, references: tuple[Image, Image]) -> float:
    """The mean of (x - r)^2 / (r^2 + 0.01), without bias by the noise of the references, which are independent.

    The square is the product of the differences from the one and from the other: its expectation is that of the
    difference from the truth.
    """
    one, other = references
    scale = ((one + other) / 2) ** 2 + 0.01
    error = ((image - one) * (image - other) / scale).mean(axis=2, dtype=np.float64)
    doubt = ((one - other) ** 2 / scale).mean(axis=2)
    return float(error[doubt <= np.quantile(doubt, 1 - OUTLIERS)].mean())


def measured(name: str, spp: int, reference_spp: int) -> tuple[float, float, float]:
    """relMSE of the noisy image, and of it denoised without and with guides."""
    scene = etendue.load(CONFIGS / f"a04_{name}.json")
    film = scene.render(spp=spp, size=SIZE, seed=1)
    one, other = (
        scene.render(spp=reference_spp, size=SIZE, seed=seed, sampler="independent").image for seed in (2, 3)
    )
    unguided, _ = denoise_film(film)
    images = (film.image, unguided.image, scene.denoise(film).image)
    noisy, alone, guided = (rel_mse(image, (one, other)) for image in images)
    return noisy, alone, guided


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE", help=", ".join(SCENES))
    parser.add_argument("--spp", type=int, default=SPP)
    parser.add_argument("--reference-spp", type=int, default=REFERENCE_SPP)
    options = parser.parse_args()
    print(f"| scene | noisy, {options.spp} spp | denoised, image alone | denoised, guided | ratio |")
    print("|---|---|---|---|---|")
    for name in options.scenes:
        noisy, alone, guided = measured(name, options.spp, options.reference_spp)
        print(f"| {name} | {noisy:.4f} | {alone:.4f} | {guided:.4f} | {noisy / guided:.1f} |", flush=True)


if __name__ == "__main__":
    main()
