"""What another processor may change: rounding, and nothing else."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from .. import builds
from . import test_light_splitting, test_portals
from .test_invariance import SIZE, cornell
from .test_light_tracing import PLACES, render
from .worlds import Estimator

RUNS, SPP = 8, 16


def images() -> np.ndarray:
    """(RUNS, SIZE, SIZE, 3): renders of the box that differ in their seeds."""
    world, camera = cornell()
    estimator = Estimator("Pathtracer", {"mis": "power"})
    return np.array([estimator.render(world, camera, SPP, seed=seed).mean() for seed in range(RUNS)])


def caustics() -> np.ndarray:
    """Renders in which light is traced from the lights."""
    places = [make() for make in PLACES.values()]
    return np.array([render(place, True, 8, sampler="sobol", path_reuse=True).mean() for place in places])


def many_lights() -> np.ndarray:
    """Renders in which several lights, or directions to windows, are sampled at first surfaces."""
    renderers = [
        test_light_splitting.renderer(test_light_splitting.lamps(), True),
        test_portals.renderer(test_portals.windows(), True, path_reuse=True),
    ]
    for renderer in renderers:
        renderer.render(8)
    return np.array([renderer.mean() for renderer in renderers])


@pytest.fixture(scope="module")
def portable() -> Path:
    """A build for any x86-64: without fused multiply-add, and with 4 lanes."""
    return builds.core_in(builds.build(builds.ROOT / "build" / "portable", "_core", "-DETENDUE_NATIVE=OFF"))


def images_by(core: Path, home: Path, what: str = "images") -> np.ndarray:
    """The renders of a function above by another build, with the Embree settings of a home folder."""
    file = home / "images.npy"
    code = (
        "import sys, numpy; sys.path.insert(0, sys.argv[3])\n"
        "from tests.conftest import _use_core; _use_core(sys.argv[1])\n"
        f"from tests.estimators import test_platforms as here; numpy.save(sys.argv[2], here.{what}())\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(core), str(file), str(builds.ROOT)],
        env={"HOME": str(home)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    return np.load(file)


@pytest.mark.slow
def test_another_width_of_registers_gives_the_same_picture(portable: Path, tmp_path: Path) -> None:
    np.testing.assert_array_equal(images_by(portable, tmp_path), images())
    np.testing.assert_array_equal(images_by(portable, tmp_path, "caustics"), caustics())
    np.testing.assert_array_equal(images_by(portable, tmp_path, "many_lights"), many_lights())


@pytest.mark.slow
def test_another_processor_gives_the_same_picture_but_for_the_rounding_of_embree(
    portable: Path, tmp_path: Path
) -> None:
    for settings in (".embree3", ".embree4"):
        (tmp_path / settings).write_text("isa=sse2\n")
    here, elsewhere = images(), images_by(portable, tmp_path)
    difference = np.abs(here - elsewhere) / (here + 1e-6)
    # Without rounding's help a path takes the same turns, so most pixels agree to the last digits.
    assert np.median(difference) < 1e-5
    assert (difference < 1e-3).mean() > 0.9
    # What turned elsewhere turned both ways.
    tiles = (
        (here - elsewhere)[..., 1].reshape(RUNS, 4, SIZE // 4, 4, SIZE // 4).mean((2, 4)).reshape(RUNS, 16)
    )
    p = np.nan_to_num(stats.ttest_1samp(tiles, 0).pvalue, nan=1)
    assert p.min() > 1e-3 / len(p)
