"""The furnished room: size, soundness, names, lamps, glass, and where the camera stands."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

from etendue.models import _fireplace_plan as plan
from etendue.models import _fireplace_textures as textures
from etendue.models import fireplace
from etendue.models.mesh import Mesh, merged
from etendue.models.model import Model

CONFIGS = Path(__file__).parents[2] / "configs"
NAMES = (
    "Floor Mirror Glass FireplaceGlass BrushedStainlessSteel Transluscent MattePaint Paneling Sofa Walls "
    "TableWood Leaves Branches Painting lambert2SG_light lambert3SG"
)
PATCHED = {plan.PREFIX + name for name in NAMES.split()}
EMITTERS = {plan.SKY, plan.LAMPS, plan.GARDEN, plan.FLAMES, plan.EMBERS}
CAMERA = np.array([4.5133, 1.5917, -3.424])


@pytest.fixture(scope="module")
def room() -> Model:
    return fireplace.model()


@pytest.fixture(scope="module")
def corners(room: Model) -> np.ndarray:
    """Every triangle of the room: (n, 3, 3)."""
    return np.concatenate([m.vertices[m.faces] for meshes in room.parts.values() for m in meshes])


def cross(p: np.ndarray) -> np.ndarray:
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def first_hit(corners: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> tuple[float, bool]:
    """Distance to the nearest triangle along a ray, and whether its front was hit."""
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(direction, e2)
    det = np.einsum("ij,ij->i", e1, p)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = origin - a
        u = np.einsum("ij,ij->i", s, p) / det
        q = np.cross(s, e1)
        v = q @ direction / det
        t = np.einsum("ij,ij->i", e2, q) / det
    t = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0), t, np.inf)
    k = int(np.argmin(t))
    return float(t[k]), bool(det[k] > 0)


def test_is_as_rich_as_promised(room: Model) -> None:
    assert 100_000 <= room.triangle_count <= 700_000


def test_has_the_materials_of_the_format_page(room: Model) -> None:
    assert set(room.parts) == set(room.materials)
    assert set(room.parts) >= PATCHED
    patched = json.loads((CONFIGS / "a04_fireplace.json").read_text())["scene"]["materials"]
    assert {p["name"] for p in patched} == PATCHED


def test_types_of_further_materials_come_from_their_names(room: Model) -> None:
    telling = ("light", "emissive", "diffuse", "fabric", "silver", "gold")
    plain = {plan.SLATE, plan.IRON, plan.CERAMIC, plan.FRUIT}
    for name in set(room.parts) - PATCHED - plain:
        assert any(word in name for word in telling), name
    assert not any(
        word in name.lower() for name in plain for word in (*telling, "glass", "metal", "water", "plastic")
    )


def test_twin_differs_in_algorithm_alone() -> None:
    one, twin = (json.loads((CONFIGS / f"a04_fireplace{end}.json").read_text()) for end in ("", "_naive"))
    assert (one.pop("algorithm"), twin.pop("algorithm")) == ("Pathtracer", "NaivePathtracer")
    assert one == twin


def test_geometry_is_sound(room: Model) -> None:
    for name, meshes in room.parts.items():
        mesh = merged(meshes)
        assert np.isfinite(mesh.vertices).all(), name
        # As written, in single precision to a micrometre.
        p = np.round(mesh.vertices, 6)[mesh.faces]
        assert (np.linalg.norm(cross(p), axis=1) > 1e-12).all(), name
        if mesh.uvs is not None:
            assert np.isfinite(mesh.uvs).all(), name


def test_normals_are_of_unit_length_and_on_the_side_of_the_front(room: Model) -> None:
    for name, meshes in room.parts.items():
        mesh = merged(meshes)
        if mesh.normals is None:
            continue
        used = np.unique(mesh.faces)
        np.testing.assert_allclose(np.linalg.norm(mesh.normals[used], axis=1), 1, atol=1e-6, err_msg=name)
        front = cross(mesh.vertices[mesh.faces])
        front /= np.linalg.norm(front, axis=1, keepdims=True)
        against = np.einsum("ij,ikj->ik", front, mesh.normals[mesh.faces]) < -0.05
        assert against.mean() < 0.004, (name, against.sum())


def test_only_lamps_windows_and_fire_emit(room: Model) -> None:
    assert {name for name, m in room.materials.items() if max(m.ke) > 0} == EMITTERS


def test_panes_shine_into_the_room(room: Model) -> None:
    middle = np.array([(plan.WEST + plan.EAST) / 2, 1.35, (plan.SOUTH + plan.NORTH) / 2])
    for name in (plan.SKY, plan.GARDEN):
        p = merged(room.parts[name]).vertices[merged(room.parts[name]).faces]
        assert (np.einsum("ij,ij->i", cross(p), middle - p.mean(1)) > 0).all()


def test_lamps_shine_down_or_out_of_their_shades_on_both_sides(room: Model) -> None:
    for mesh in room.parts[plan.LAMPS]:
        p = mesh.vertices[mesh.faces]
        if np.ptp(mesh.vertices[:, 1]) < 1e-6:
            assert (cross(p)[:, 1] < 0).all()
            continue
        axis = (mesh.vertices.min(0) + mesh.vertices.max(0)) / 2
        outwards = np.einsum("ij,ij->i", cross(p)[:, [0, 2]], (p.mean(1) - axis)[:, [0, 2]]) > 0
        assert outwards.all() or not outwards.any()
        # What shines outwards shows the dim left of its texture, what shines inwards the bright right.
        assert mesh.uvs is not None
        assert ((mesh.uvs[:, 0] < 0.5) == outwards.all()).all()


def test_flames_shine_out_of_the_hearth(room: Model) -> None:
    for mesh in room.parts[plan.FLAMES]:
        assert cross(mesh.vertices[mesh.faces])[:, 0].mean() > 0


@pytest.mark.parametrize("name", [plan.GLASS, plan.FIRE_GLASS])
def test_glass_is_closed(room: Model, name: str) -> None:
    for mesh in room.parts[name]:
        assert_closed(mesh)


def assert_closed(mesh: Mesh) -> None:
    """Every edge is shared by two triangles that run along it in opposite ways; the volume is inside."""
    _, place = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    f = place.reshape(-1)[mesh.faces]
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    there, counts = np.unique(edges, axis=0, return_counts=True)
    assert (counts == 1).all()
    assert {tuple(e) for e in there.tolist()} == {tuple(e) for e in there[:, ::-1].tolist()}
    p = mesh.vertices[mesh.faces]
    assert np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2])) > 0


def test_camera_stands_free_in_a_closed_room(corners: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    for direction in rng.normal(size=(8, 3)):
        distance, front = first_hit(corners, CAMERA, direction / np.linalg.norm(direction))
        assert 0.3 < distance < 12
        assert front


def test_camera_sees_the_fire(room: Model, corners: np.ndarray) -> None:
    fire = merged(room.parts[plan.FLAMES]).vertices.mean(0)
    pane = merged(room.parts[plan.FIRE_GLASS]).vertices.mean(0)
    ray = (fire - CAMERA) / np.linalg.norm(fire - CAMERA)
    distance, front = first_hit(corners, CAMERA, ray)
    assert front
    assert abs(distance - np.linalg.norm(pane - CAMERA)) < 0.1


def test_is_the_same_every_time(room: Model) -> None:
    def digest(model: Model) -> str:
        sums = hashlib.sha256()
        for name, meshes in model.parts.items():
            sums.update(name.encode())
            for m in meshes:
                sums.update(m.vertices.tobytes() + m.faces.tobytes())
        return sums.hexdigest()

    assert digest(room) == digest(fireplace.model())


def test_writes_textures_that_repeat_exactly(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        textures.write(textures.leaf(np.random.default_rng(3)), tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_names_only_textures_that_are_built(room: Model) -> None:
    named = {t for m in room.materials.values() for t in (m.map_kd, m.map_d, m.map_bump, m.map_ke) if t}
    assert named == {f"{name}.png" for name in fireplace.TEXTURES}


def test_refuses_to_write_where_it_cannot(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        textures.write(np.zeros((4, 4, 3)), tmp_path / "file" / "x.png")
