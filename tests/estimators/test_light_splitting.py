"""Several lights sampled at the first surface of each path: the picture stays, its noise falls, where that pays."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .worlds import check_pieces, diffuse, ground, lamp, looking, scene

SEEDS, SPP, SIDE = 48, 16, 32


def lamps(largest: float = 0.3) -> tuple[_core.Scene, _core.Camera]:
    """A glossy floor, whose reflections of lamps both techniques find, lamps of all sizes, a card that hides some."""
    glossy = _core.Material(
        "glossy", "layered_ggx", (0.6, 0.5, 0.4), ior=1.8, roughness=0.2, absorb=0, coated=True
    )
    rng = np.random.default_rng(6)
    parts = [(ground(3), glossy), (meshes.box(1, 0.7, 0.02).moved(x=0.2, y=0.35, z=-0.2), diffuse(0.7))]
    for x, y, z, s in rng.uniform((-1, 0.2, -1, 0.02), (1, 0.9, 1, largest), (24, 4)):
        parts.append((meshes.quad((x, y, z), (x + s, y, z), (x + s, y, z + s), (x, y, z + s)), lamp(20 / s)))
    return scene(*parts), looking((0, 1.2, 1.4), (0, 0, 0), SIDE, fov=60)


def renderer(place: tuple[_core.Scene, _core.Camera], splits: bool, **more: object) -> _core.Renderer:
    """Deals with `sampler`, `seed`, `threads` and the estimator's parameters."""
    settings = {
        name: more.pop(name) for name in ("sampler", "seed", "threads", "first_sample") if name in more
    }
    parameters = {"light_splitting": splits, "path_reuse": False, "max_cam_path_length": 4, **more}
    made = _core.Renderer(*place, "Pathtracer", parameters, **settings)
    made.prepare()
    assert (made.light_samples > 1) == splits
    return made


def pictures(splits: bool, seeds: int = SEEDS, **more: object) -> NDArray[np.float64]:
    """(seeds, height, width, 3)."""
    images, place = [], lamps()
    for seed in range(seeds):
        made = renderer(place, splits, seed=seed + 1000 * splits, **more)
        made.render(SPP)
        assert made.invalid_count == 0
        images.append(made.mean())
    return np.asarray(images, np.float64)


@pytest.mark.parametrize(
    "more", [{}, {"mis": "balance"}, {"mis": "none"}, {"path_reuse": True}, {"rr_threshold": 0.9}]
)
def test_the_mean_stays(more: dict[str, object]) -> None:
    """Welch's t-test of each block of 4 x 4 pixels, or of each tile where pixels share."""
    block = 16 if more.get("path_reuse") else 4
    ours, theirs = (
        pictures(splits, sampler="independent", **more)
        .reshape(SEEDS, SIDE // block, block, SIDE // block, block, 3)
        .mean((2, 4))
        for splits in (True, False)
    )
    varies = (ours.std(0) > 0) | (theirs.std(0) > 0)
    p = stats.ttest_ind(ours[:, varies], theirs[:, varies], axis=0, equal_var=False).pvalue
    assert p.min() * p.size > 1e-3
    np.testing.assert_array_equal(ours[0, ~varies], theirs[0, ~varies])


def test_noise_falls() -> None:
    """By more than so many samples do on their own, as those of a pixel are stratified together."""
    ours, theirs = (pictures(splits, 24, max_cam_path_length=2).var(0).mean(2) for splits in (True, False))
    lit = theirs > 0
    samples = renderer(lamps(), True).light_samples
    assert np.median(ours[lit] / theirs[lit]) < 1 / samples


def test_lights_are_split_where_it_pays() -> None:
    """Not where there is no light to sample, most noise is of what paths find further on, or little is gained."""
    dark = scene((ground(), diffuse()))
    assert _core.Renderer(dark, looking((0, 1, 1), (0, 0, 0)), "Pathtracer").light_samples == 1
    hidden = meshes.quad((-0.5, 0.3, -0.5), (0.5, 0.3, -0.5), (0.5, 0.3, 0.5), (-0.5, 0.3, 0.5))
    closed = scene((meshes.box(2, 2, 2).moved(y=1).flipped(), diffuse(0.8)), (hidden, lamp(5)))
    above = looking((0, 1.9, 0.2), (0, 0.5, -1), SIDE, fov=40)
    assert _core.Renderer(closed, above, "Pathtracer", {"path_reuse": False}).light_samples == 1
    assert _core.Renderer(*lamps(), "Pathtracer", {"max_cam_path_length": 1}).light_samples == 1
    assert _core.Renderer(*lamps(), "NaivePathtracer").light_samples == 1
    little = {"path_reuse": False, "max_cam_path_length": 4}
    assert _core.Renderer(*lamps(0.1), "Pathtracer", little).light_samples == 1
    assert _core.Renderer(*lamps(), "Pathtracer", little).light_samples > 1


@pytest.mark.parametrize("sampler", _core.samplers())
def test_pieces_are_the_whole(sampler: str) -> None:
    place = lamps()
    check_pieces(lambda **options: renderer(place, True, sampler=sampler, **options))


def test_a_replay_tells_of_each_light() -> None:
    place = lamps()
    made = renderer(place, True, mis="balance")
    told = 0
    for x in range(0, SIDE, 3):
        path = _core.replay(made, x, SIDE - 4, 0)
        first = path.vertices[0]
        lit = [c for c in first.contributions if c.technique == "light_sampling"]
        assert len(lit) <= len(first.shadow_rays) <= made.light_samples
        assert all(c.edges == 2 for c in lit)
        assert all(ray.visible for ray in first.shadow_rays) or len(lit) < len(first.shadow_rays)
        total = sum(
            np.multiply(c.unweighted, c.weight) for vertex in path.vertices for c in vertex.contributions
        )
        np.testing.assert_allclose(total, path.radiance, rtol=1e-5, atol=1e-6)
        told += len(first.shadow_rays) > 1
    assert told > 0
