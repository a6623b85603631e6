"""What is recorded beside the picture: surfaces by the picture's own rays, and its contributions kept apart."""

from __future__ import annotations

import numpy as np
import pytest

from etendue import _core
from etendue.models import mesh as meshes

from .test_invariance import cornell
from .worlds import Estimator, core_mesh, diffuse, estimators, ground, lamp, scene

SPP = 16
SEEN = Estimator("NaivePathtracer")


def pass_over(world: _core.Scene, camera: _core.Camera, samples: int = SPP, first: int = 0, **how):
    found = _core.AovPass(world, camera, **{"sampler": "independent", **how})
    assert found.render(first, samples)
    return found


def camera(pos, at, size=16, fov=40.0, lens=0.0, focus=1.0, perspective=True) -> _core.Camera:
    direction = tuple(np.subtract(at, pos))
    up = (0, 1, 0) if abs(direction[1]) < 0.99 * np.linalg.norm(direction) else (0, 0, 1)
    return _core.Camera(pos, direction, up, fov, lens, focus, perspective, size, size)


def card(x0: float, x1: float, z: float, size: float = 40) -> meshes.Mesh:
    """Upright, facing +z, from x0 to x1."""
    return meshes.quad((x0, -size, z), (x1, -size, z), (x1, size, z), (x0, size, z))


def test_a_plane_seen_from_above() -> None:
    world = scene((ground(20), _core.Material("grey", "diffuse", (0.1, 0.2, 0.3))))
    found = pass_over(world, camera((1, 3, 2), (1, 0, 2)))
    np.testing.assert_allclose(found.depth(), 3, rtol=1e-5)
    np.testing.assert_allclose(found.normal(), np.broadcast_to([0, 1, 0], (16, 16, 3)), atol=1e-6)
    np.testing.assert_allclose(found.albedo(), np.broadcast_to(np.float32([0.1, 0.2, 0.3]), (16, 16, 3)))
    position = found.position()
    np.testing.assert_allclose(position[..., 1], 0, atol=1e-6)
    # Up is z: columns go to -x and rows to -z, by the height of a pixel on the plane.
    step = 2 * 3 * np.tan(np.radians(20)) / 16
    np.testing.assert_allclose(np.diff(position[..., 0], axis=1).mean(), -step, rtol=0.01)
    np.testing.assert_allclose(np.diff(position[..., 2], axis=0).mean(), -step, rtol=0.01)
    np.testing.assert_allclose(position.mean(axis=(0, 1)), [1, 0, 2], atol=0.02)


def test_depth_of_a_panorama_is_the_distance() -> None:
    sphere = meshes.sphere(2, 128, 64).moved(1, 2, 3)
    found = pass_over(scene((sphere, diffuse())), camera((1, 2, 3), (5, 2, 3), perspective=False))
    np.testing.assert_allclose(found.depth(), 2, rtol=2e-3)


def test_nothing_is_seen_as_nothing() -> None:
    world = scene((ground(1), diffuse()), sky=_core.Sky(None, 0.25))
    found = pass_over(world, camera((0, 1, 0), (0, 5, 0)))
    assert np.isposinf(found.depth()).all()
    for array in (found.albedo(), found.normal(), found.position(), found.denoising_normal()):
        assert array.max() == array.min() == 0
    assert (found.object_id() == -1).all()
    assert (found.material_id() == -1).all()
    assert (found.denoising_albedo() == 0.25).all(), "what shines guides the denoiser"


# A card of radiance 1 before a black one: the picture is the share of rays that end on the first.
NEAR, FAR = 2.0, 6.0


@pytest.mark.parametrize("sampler", _core.samplers())
@pytest.mark.parametrize("filter", ["box", "blackman_harris"])
@pytest.mark.parametrize("lens", [0.0, 0.5], ids=["pinhole", "lens"])
def test_edges_are_those_of_the_picture(sampler: str, filter: str, lens: float) -> None:
    world = scene((card(0.03, 40, -NEAR), lamp(1)), (card(-40, 40, -FAR), diffuse(0.5)))
    view = camera((0, 0, 0), (0, 0, -1), lens=lens, focus=FAR)
    how = {"sampler": sampler, "filter": filter, "seed": 7}
    picture = SEEN.render(world, view, SPP, edges=1, first_sample=3, **how).mean()[..., 0].astype(float)
    assert ((picture > 0) & (picture < 1)).any()
    assert (lens > 0) == (((picture > 0) & (picture < 1)).sum() > 40), "a lens blurs the edge"
    found = pass_over(world, view, first=3, **how)
    np.testing.assert_allclose(found.depth(), picture * NEAR + (1 - picture) * FAR, rtol=1e-6)
    np.testing.assert_allclose(found.position()[..., 2], -found.depth(), rtol=1e-6)
    np.testing.assert_allclose(found.albedo()[..., 0], (1 - picture) * 0.5, atol=1e-7)
    decided = picture != 0.5
    np.testing.assert_array_equal(found.object_id()[decided], np.where(picture > 0.5, 0, 1)[decided])
    np.testing.assert_array_equal(found.object_id(), found.material_id())


def test_cut_outs_are_passed_as_the_picture_passes_them() -> None:
    left_half_gone = np.full((1, 32, 4), 255, np.uint8)
    left_half_gone[0, :16, 3] = 0
    corners = np.float32([(-1, -1, -NEAR), (1, -1, -NEAR), (1, 1, -NEAR), (-1, 1, -NEAR)])
    leaf = _core.Mesh(
        corners, np.uint32([(0, 1, 2), (0, 2, 3)]), None, np.float32([(0, 0), (1, 0), (1, 1), (0, 1)]), 0
    )
    shining = _core.Material("leaf", "light", (1, 1, 1), emissive_strength=1.0, cutout_texture=0)
    behind = core_mesh(card(-40, 40, -FAR), 1)
    world = _core.Scene([leaf, behind], [shining, diffuse(0.5)], [_core.Texture(left_half_gone, True)], None)
    view = camera((0, 0, 0), (0, 0, -1), fov=45)
    picture = SEEN.render(world, view, SPP, edges=1).mean()[..., 0].astype(float)
    assert set(picture[4:12, 2:6].flat) == {0.0}, "the picture is cut out"
    assert set(picture[4:12, 10:14].flat) == {1.0}
    found = pass_over(world, view)
    np.testing.assert_allclose(found.depth(), picture * NEAR + (1 - picture) * FAR, rtol=1e-6)
    decided = picture != 0.5
    np.testing.assert_array_equal(found.object_id()[decided], np.where(picture > 0.5, 0, 1)[decided])


def test_ids_tell_meshes_and_materials_apart() -> None:
    cards = [core_mesh(card(-40, 0, -FAR), 0), core_mesh(card(0, 40, -FAR), 0)]
    world = _core.Scene(cards, [diffuse()], [], None)
    found = pass_over(world, camera((0, 0, 0), (0, 0, -1)))
    assert set(found.object_id()[:, :6].flat) == {0}
    assert set(found.object_id()[:, -6:].flat) == {1}
    assert set(found.material_id().flat) == {0}


def test_the_denoiser_is_guided_through_mirrors() -> None:
    """A red wall behind the camera, in a mirror that reflects 87%: F = ((30 - 1) / (30 + 1))^2 head on."""
    mirror = _core.Material("mirror", "specular", (1, 1, 1), 30.0)
    red = _core.Material("red", "diffuse", (0.8, 0.1, 0.1))
    wall = card(-40, 40, 4).turned("y", 180).moved(z=8)
    world = scene((card(-40, 40, -2), mirror), (wall, red))
    found = pass_over(world, camera((0, 0, 0), (0, 0, -1), fov=1))
    reflectance = (29 / 31) ** 2
    np.testing.assert_allclose(
        found.denoising_albedo()[0, 0], np.multiply((0.8, 0.1, 0.1), reflectance), rtol=1e-3
    )
    np.testing.assert_allclose(found.denoising_normal(), np.broadcast_to([0, 0, -1], (16, 16, 3)), atol=1e-6)
    # What is seen first is the mirror.
    np.testing.assert_allclose(found.albedo(), reflectance, rtol=1e-3)
    np.testing.assert_allclose(found.normal(), np.broadcast_to([0, 0, 1], (16, 16, 3)), atol=1e-6)
    np.testing.assert_allclose(found.depth(), 2, rtol=1e-5)


def test_the_denoiser_is_guided_through_glass_along_the_estimators_paths() -> None:
    """Of a lamp of radiance 1, seen through a pane and mirrored in it: the picture itself."""
    pane = meshes.box(8, 8, 0.5).moved(z=-3)
    world = scene((pane, _core.Material("pane", "glass", (1, 1, 1), 1.5)), (card(-9, 9, -6), lamp(1)))
    view = camera((0, 0, 0), (0.5, 0.2, -1), fov=60)
    naive = Estimator("NaivePathtracer", {"rr_threshold": 0.0})
    picture = naive.render(world, view, SPP, edges=17, seed=3).mean()
    assert picture.std() > 0, "the pane reflects some"
    found = pass_over(world, view, seed=3)
    np.testing.assert_allclose(found.denoising_albedo(), picture, rtol=1e-4, atol=1e-5)


def test_glass_does_not_dim_the_guide_by_compressing_radiance() -> None:
    """Of a lamp inside of glass the picture sees 1 / 1.5^2 of the radiance, but nothing was absorbed."""
    block = meshes.box(8, 8, 4).moved(z=-5)
    world = scene((block, _core.Material("block", "glass", (1, 1, 1), 1.5)), (card(-3, 3, -4, 3), lamp(1)))
    view = camera((0, 0, 0), (0, 0, -1), fov=5)
    picture = SEEN.render(world, view, SPP, edges=2, seed=3).mean()
    assert picture.min() > 0
    found = pass_over(world, view, seed=3)
    np.testing.assert_allclose(found.denoising_albedo(), picture * 1.5**2, rtol=1e-4)


def test_a_pass_ends_when_its_progress_raises() -> None:
    class Enough(Exception):
        pass

    def enough(part: float) -> None:
        assert 0 <= part <= 1
        raise Enough

    world, view = cornell()
    found = _core.AovPass(world, view)
    with pytest.raises(Enough):
        found.render(0, 10**9, enough)
    seen: list[float] = []
    assert found.render(0, 1, seen.append)
    assert seen[-1] == 1


def split_render(estimator: Estimator, **how) -> _core.Renderer:
    world, view = cornell()
    renderer = _core.Renderer(
        world, view, estimator.algorithm, estimator.parameters, sampler="independent", seed=4, **how
    )
    renderer.split()
    assert renderer.render(SPP)
    return renderer


@pytest.mark.parametrize("estimator", list(estimators(roulette=(1,))), ids=str)
def test_contributions_add_up_to_the_picture(estimator: Estimator) -> None:
    world, view = cornell()
    plain = _core.Renderer(
        world, view, estimator.algorithm, estimator.parameters, sampler="independent", seed=4
    )
    assert plain.contributions() is None
    plain.render(SPP)
    renderer = split_render(estimator, threads=2)
    np.testing.assert_array_equal(renderer.sum(), plain.sum(), err_msg="keeping apart changes nothing")
    contributions = renderer.contributions()
    assert contributions.shape == (*renderer.sum().shape[:2], 2, 2, 3)
    # Each sample's radiance is a sum of single precision.
    np.testing.assert_allclose(contributions.sum(axis=(2, 3)), renderer.sum(), rtol=2e-6, atol=1e-9)
    if not estimator.algorithm.startswith(("Path", "Direct")):
        assert contributions[:, :, 1].max() == 0, "light is sampled by nobody else"
    if estimator.longest_path == 2:
        assert contributions[:, :, :, 1].max() == 0, "two edges are direct"


def test_direct_is_the_picture_of_two_edges() -> None:
    world, view = cornell()
    # How many lights pay depends on how long paths may get; the random numbers of a vertex do not.
    one_light = Estimator("Pathtracer", {"light_splitting": False})
    both = split_render(one_light).contributions()
    short = one_light.render(world, view, SPP, edges=2, seed=4)
    np.testing.assert_allclose(both[:, :, :, 0].sum(axis=2), short.sum(), rtol=2e-6, atol=1e-9)


def test_contributions_are_those_of_the_split_picture() -> None:
    renderer = split_render(Estimator("Pathtracer"))
    film = _core.TechniqueFilm(renderer, 10)
    assert film.render(SPP)
    mean = film.mean()[0]
    parts = np.stack([mean[:, :2].sum(axis=1), mean[:, 2:].sum(axis=1)])  # part, technique, h, w, 3
    np.testing.assert_allclose(
        renderer.contributions() / SPP, np.moveaxis(parts, (1, 0), (2, 3)), rtol=1e-4, atol=1e-6
    )


def test_contributions_go_on_where_another_renderer_was() -> None:
    whole = split_render(Estimator("Pathtracer"))
    world, view = cornell()
    first = _core.Renderer(world, view, "Pathtracer", sampler="independent", seed=4)
    first.split()
    first.render(5)
    second = _core.Renderer(world, view, "Pathtracer", sampler="independent", seed=4)
    sums = (
        first.sum(),
        first.sum_squares(),
        first.half_sum(),
        first.sample_count(),
        first.invalid_per_pixel(),
        first.half_count(),
    )
    second.resume(*sums)
    second.split(first.contributions())
    second.render(SPP)
    np.testing.assert_allclose(second.contributions(), whole.contributions(), rtol=1e-12, atol=1e-15)
    with pytest.raises(ValueError, match="contributions"):
        second.split(np.zeros((3, 3, 2, 2, 3)))
