"""What estimators tell about their paths: replays, and the picture split by technique."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .test_invariance import SIZE, cornell
from .worlds import Estimator, diffuse, estimators, ground, lamp, looking, scene

PIXELS = [(0, 0), (5, 20), (16, 16), (16, 3), (31, 30)]


@pytest.mark.parametrize("sampler", _core.samplers())
@pytest.mark.parametrize("estimator", list(estimators(roulette=(1,))), ids=str)
def test_a_replay_is_the_sample_of_the_render(estimator: Estimator, sampler: str) -> None:
    world, camera = cornell()
    for first in (0, 3):
        film = estimator.render(world, camera, 1, sampler=sampler, seed=5, first_sample=first)
        image = film.mean()
        for x, y in PIXELS:
            assert _core.replay(film, x, y, first).radiance == image[y, x].tolist()


@pytest.mark.parametrize("estimator", list(estimators(roulette=(1,))), ids=str)
def test_a_replay_tells_where_the_radiance_is_from(estimator: Estimator) -> None:
    world, camera = cornell()
    film = estimator.render(world, camera, 1, seed=5)
    shared = 0
    for x, y in PIXELS:
        path = _core.replay(film, x, y, 0)
        found = [c for vertex in path.vertices for c in vertex.contributions]
        assert not any(c.borrowed for c in found)
        assert all(c.borrowed for c in path.borrowed)
        shared += len(path.borrowed)
        found += path.borrowed + path.from_lights
        total = sum((np.multiply(c.unweighted, c.weight) for c in found), np.zeros(3))
        np.testing.assert_allclose(total, path.radiance, rtol=1e-5)
        throughput = np.ones(3)
        for edges, vertex in enumerate(path.vertices, start=1):
            np.testing.assert_allclose(vertex.throughput, throughput, rtol=1e-5)
            assert all(c.edges == edges + (c.technique == "light_sampling") for c in vertex.contributions), (
                "path length counts rays"
            )
            if vertex.bounce_weight is not None:
                throughput = throughput * vertex.bounce_weight
            if vertex.roulette_survived:
                throughput = throughput / (1 - vertex.roulette_q)
        for here, there in zip(path.vertices, path.vertices[1:], strict=False):
            np.testing.assert_allclose(there.origin, here.position, atol=1e-4)
    assert (shared > 0) == (film.sharing > 1)


def test_weights_of_a_replay_are_of_its_pdfs() -> None:
    world, camera = cornell()
    for mis, power in (("power", 2), ("balance", 1)):
        film = Estimator("Pathtracer", {"mis": mis}).render(world, camera, 1)
        found = [
            c
            for y, x in np.ndindex(SIZE, SIZE)
            for vertex in _core.replay(film, x, y, 0).vertices
            for c in vertex.contributions
            if c.pdf > 0
        ]
        assert {c.technique for c in found} == {"bsdf_sampling", "light_sampling"}
        for c in found:
            assert c.weight == pytest.approx(c.pdf**power / (c.pdf**power + c.other_pdf**power), rel=1e-4)


def test_a_replay_names_what_it_meets() -> None:
    world = scene((ground(), diffuse()), sky=_core.Sky(intensity=2))
    film = Estimator("NaivePathtracer").render(world, looking((0, 1, 1), (0, 0, 0)), 1)
    floor, sky = _core.replay(film, 0, 0, 0).vertices
    assert (floor.material, floor.bsdf, floor.hit, floor.front) == ("surface", "diffuse", True, True)
    assert floor.bounce_lobe == "diffuse reflection"
    np.testing.assert_allclose(floor.position, 0, atol=1e-4)
    np.testing.assert_allclose(floor.normal, (0, 1, 0), atol=1e-6)
    assert floor.distance == pytest.approx(np.sqrt(2), rel=1e-4)
    assert (sky.hit, sky.material, sky.bounce_lobe) == (False, "", None)
    assert sky.contributions[0].unweighted == pytest.approx((1, 1, 1))


def test_a_replay_of_a_pixel_outside_is_refused() -> None:
    film = Estimator("NaivePathtracer").render(*cornell(), 1)
    with pytest.raises(ValueError, match="no pixel 32,0 in an image of 32x32"):
        _core.replay(film, SIZE, 0, 0)


@pytest.mark.parametrize("max_edges", [10, 3])
@pytest.mark.parametrize("estimator", list(estimators(roulette=(1,))), ids=str)
def test_techniques_add_up_to_the_picture(estimator: Estimator, max_edges: int) -> None:
    renderer = estimator.render(*cornell(), spp=4, threads=2)
    film = _core.TechniqueFilm(renderer, max_edges)
    assert film.render(1)
    assert film.render(3)
    assert film.samples == 4
    np.testing.assert_allclose(film.mean()[0].sum((0, 1)), renderer.mean(), rtol=1e-4, atol=1e-6)


def test_techniques_agree_where_both_can_find_the_light() -> None:
    """Before the weights each technique is a whole estimator of the light that both can find."""
    world = scene(
        (ground(), diffuse()),
        (meshes.quad((-0.3, 1, -0.3), (0.3, 1, -0.3), (0.3, 1, 0.3), (-0.3, 1, 0.3)), lamp(3)),
    )
    camera = looking((0, 0.5, 1), (0, 0, 0), size=8)
    runs = []
    for seed in range(24):
        renderer = Estimator("Pathtracer", {"mis": "power"}).render(world, camera, 1, seed=seed)
        film = _core.TechniqueFilm(renderer, 2)
        film.render(64)
        runs.append(film.mean()[:, :, 1].mean((2, 3, 4)))
    weighted, unweighted = np.array(runs).transpose(1, 0, 2)
    assert stats.ttest_ind(unweighted[:, 0], unweighted[:, 1], equal_var=False).pvalue > 1e-3
    combined = weighted.sum(1)
    assert stats.ttest_ind(combined, unweighted[:, 1], equal_var=False).pvalue > 1e-3
    assert 0 < weighted[:, 0].mean() < unweighted[:, 0].mean()


def test_variance_by_technique_is_that_of_the_samples() -> None:
    estimator = Estimator("DirectIllumination")
    world, camera = cornell()
    film = _core.TechniqueFilm(estimator.render(world, camera, 1), 2)
    film.render(8)
    samples = [
        estimator.render(world, camera, 1, edges=2, first_sample=i).mean()
        - estimator.render(world, camera, 1, edges=1, first_sample=i).mean()
        for i in range(8)
    ]
    expected = np.var(samples, axis=0, ddof=1)
    glass = film.mean()[0, 0, 1].sum(-1) > 0  # seen by BSDF sampling as well
    np.testing.assert_allclose(
        film.variance()[0, 1, 1][~glass], expected[~glass], rtol=1e-3, atol=1e-5 * expected.max()
    )
