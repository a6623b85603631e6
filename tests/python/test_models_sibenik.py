"""The bundled cathedral: what its OBJ files promise to the scene files that use them."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from etendue.models import sibenik
from etendue.models._sibenik_dome import LIT
from etendue.models._sibenik_plan import AISLE_OUT, CROSSING, FLOOR
from etendue.models._sibenik_shapes import Arch, arched, block, circle, cluster, pierced, welded
from etendue.models.mesh import Mesh, merged
from etendue.models.model import Model

# One worker models the church for all tests.
pytestmark = pytest.mark.xdist_group("sibenik")

CONFIGS = Path(__file__).parents[2] / "configs"
CAMERA = np.array([-7.1731, 1.0279, 5.1179])
PATCHED = {
    "kamen_zid",
    "kamen_zid_parapet",
    "pod",
    "pod_tepih",
    "sprljci",
    "staklo_glass",
    "staklo_glass_crveno",
    "staklo_glass_plavo",
    "staklo_glass_zeleno",
    "staklo_glass_zuto",
    "light",
}


@pytest.fixture(scope="module")
def base() -> Model:
    return sibenik.base()


@pytest.fixture(scope="module")
def dome() -> Model:
    return sibenik.light_dome()


def face_vectors(mesh: Mesh) -> np.ndarray:
    p = mesh.vertices[mesh.faces]
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) / 2


def hits_along(meshes: list[Mesh], origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Distances at which a ray meets triangles, negative where it meets their backs (none at 0)."""
    found = []
    for mesh in meshes:
        p = mesh.vertices[mesh.faces]
        e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        h = np.cross(direction, e2)
        det = np.einsum("ij,ij->i", e1, h)
        ok = np.abs(det) > 1e-14
        inverse = 1 / np.where(ok, det, 1)
        s = origin - p[:, 0]
        u = np.einsum("ij,ij->i", s, h) * inverse
        q = np.cross(s, e1)
        v = q @ direction * inverse
        t = np.einsum("ij,ij->i", e2, q) * inverse
        hit = ok & (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-6)
        found.append(np.where(det > 0, t, -t)[hit])
    return np.concatenate(found)


def test_has_the_triangles_and_materials_that_configs_expect(base: Model, dome: Model) -> None:
    assert base.triangle_count + dome.triangle_count >= 70_000
    assert set(base.parts) | set(dome.parts) >= PATCHED
    assert set(dome.parts) == {"light"}


@pytest.mark.parametrize("name", ["a04_sibenik.json", "a04_sibenik_naive.json"])
def test_configs_patch_only_materials_that_exist(name: str, base: Model, dome: Model) -> None:
    config = json.loads((CONFIGS / name).read_text())
    assert {m["name"] for m in config["scene"]["materials"]} == PATCHED
    assert config["scene"]["mesh_files"] == ["sibenik/sibenik_base.obj", "sibenik/sibenik_light_dome.obj"]


def test_naive_twin_differs_in_its_algorithm_alone() -> None:
    one, naive = (json.loads((CONFIGS / f"a04_sibenik{end}.json").read_text()) for end in ("", "_naive"))
    assert (one.pop("algorithm"), naive.pop("algorithm")) == ("Pathtracer", "NaivePathtracer")
    assert one == naive


def test_meshes_are_finite_and_without_degenerate_triangles(base: Model, dome: Model) -> None:
    for model in (base, dome):
        for name, meshes in model.parts.items():
            for mesh in meshes:
                assert np.isfinite(mesh.vertices).all()
                # As written: six decimals.
                rounded = Mesh(np.round(mesh.vertices, 6), mesh.faces)
                assert np.linalg.norm(face_vectors(rounded), axis=1).min() > 1e-12, name


def test_normals_are_unit_and_on_the_side_of_their_faces(base: Model) -> None:
    for name, meshes in base.parts.items():
        for mesh in meshes:
            if mesh.normals is None:
                continue
            assert np.abs(np.linalg.norm(mesh.normals, axis=1) - 1).max() < 1e-6
            flat = face_vectors(mesh)
            flat /= np.linalg.norm(flat, axis=1, keepdims=True)
            cosines = np.einsum("ijk,ik->ij", mesh.normals[mesh.faces], flat)
            assert cosines.min() > 0, name


def test_panes_of_glass_are_closed(base: Model) -> None:
    for name, meshes in base.parts.items():
        if "staklo" not in name:
            continue
        for mesh in {id(m.faces): m for m in meshes}.values():
            whole = welded(Mesh(mesh.vertices, mesh.faces))
            edges = Counter(
                tuple(edge) for face in whole.faces for edge in zip(face, np.roll(face, -1), strict=True)
            )
            assert set(edges.values()) == {1}
            assert all((b, a) in edges for a, b in edges), name
            volume = np.einsum("ij,ij->", whole.vertices[whole.faces][:, 0], face_vectors(whole)) / 3
            assert volume > 0


def test_lamps_of_the_dome_shine_into_the_church(dome: Model) -> None:
    inside = np.array([CROSSING, 9.0 + FLOOR, 0.0])
    assert len(dome.parts["light"]) == len(LIT) + 2
    for lamp in dome.parts["light"]:
        area = face_vectors(lamp)
        assert np.linalg.norm(area.sum(0)) == pytest.approx(np.linalg.norm(area, axis=1).sum())
        assert area.sum(0) @ (inside - lamp.vertices.mean(0)) > 0
    total = sum(np.linalg.norm(face_vectors(m), axis=1).sum() for m in dome.parts["light"])
    assert 0.5 < total < 2.5


def test_panels_behind_the_windows_shine_inwards(base: Model) -> None:
    for name in (sibenik.SKY, sibenik.SUN):
        assert "light" in name
        for panel in base.parts[name]:
            middle, area = panel.vertices.mean(0), face_vectors(panel).sum(0)
            towards = np.array([CROSSING, middle[1], 0]) - middle
            assert area @ towards > 0


def test_camera_stands_free_in_the_south_aisle(base: Model) -> None:
    meshes = [merged(Mesh(m.vertices, m.faces) for parts in base.parts.values() for m in parts)]
    down = hits_along(meshes, CAMERA, np.array([0.0, -1.0, 0.0]))
    assert 1.0 < np.abs(down).min() < 1.7
    assert CAMERA[2] < AISLE_OUT
    for direction in ([0.79504, 0.06343, -0.60323], [0.01, 0, 1], [-1, 0.02, 0.01]):
        hits = hits_along(meshes, CAMERA, np.array(direction, float))
        nearest = hits[np.abs(hits).argmin()]
        assert abs(nearest) > 0.4
        assert nearest > 0, direction  # the first thing seen shows its front


def test_build_writes_the_same_bytes_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The textures and the whole church take long; the seeds that matter are those of the floor and the lamps.
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        sibenik.light_dome().write(tmp_path / folder / "dome.obj")
        floor = Model()
        for name in ("pod", "fuga", "kamen_zid_parapet", "pod_tepih"):
            floor.material(name)
        sibenik.add_floor(floor)
        floor.write(tmp_path / folder / "floor.obj")
    for name in ("dome.obj", "floor.obj", "floor.mtl"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def outline_area(p: np.ndarray) -> float:
    q = np.roll(p, -1, 0)
    return float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / 2)


@pytest.mark.parametrize("hole", [circle(1.5, 48) + [0, 2.8], Arch(0.4, 0.3).outline(1.6, 0.16) + [0.3, 3.3]])
def test_a_pierced_wall_covers_the_rectangle_less_the_hole(hole: np.ndarray) -> None:
    areas = face_vectors(pierced(-3.1, 3.1, 0, 5.6, hole))
    assert areas[:, 2].min() > 0
    assert areas[:, 2].sum() == pytest.approx(6.2 * 5.6 - outline_area(hole))


def test_an_arched_wall_covers_the_rectangle_less_the_arch() -> None:
    curve = Arch(1.72, 0.3).curve(0.335)
    areas = face_vectors(arched(-2.15, 2.15, 0, 2.6, curve))
    assert areas[:, 2].sum() == pytest.approx(4.3 * 2.6 - outline_area(curve))


def test_a_bevelled_block_is_closed_and_faces_outwards() -> None:
    mesh = block(0, 1, 0, 2, 0, 3, 0.1)
    whole = welded(Mesh(mesh.vertices, mesh.faces))
    edges = {tuple(edge) for face in whole.faces for edge in zip(face, np.roll(face, -1), strict=True)}
    assert all((b, a) in edges for a, b in edges)
    volume = np.einsum("ij,ij->", mesh.vertices[mesh.faces][:, 0], face_vectors(mesh)) / 3
    assert 5.8 < volume < 6


def test_clustered_shafts_have_the_reach_of_their_circles() -> None:
    mesh = cluster([(0, 0, 0.3), (0.3, 0, 0.1)], [(0, 0), (0.05, 1)])
    reach = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2])
    low = np.isclose(mesh.vertices[:, 1], 0)
    assert reach[low].max() == pytest.approx(0.4, abs=0.005)
    assert reach[~low].max() == pytest.approx(0.45, abs=0.005)
    assert merged([mesh, mesh]).normals is not None


def test_the_carpet_shows_its_texture_across_and_along(base: Model) -> None:
    (carpet,) = base.parts["pod_tepih"]
    assert carpet.uvs is not None
    width = np.clip(carpet.vertices[:, 2] / 0.9, -1, 1)
    assert np.abs(carpet.uvs[:, 1] - (width + 1) / 2).max() < 0.03
    west, east = carpet.vertices[:, 0].argmin(), carpet.vertices[:, 0].argmax()
    assert carpet.uvs[east, 0] - carpet.uvs[west, 0] > 15
