"""The palace court."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from etendue.models import SCENES, _spz_fabrics, _spz_garden, _spz_kit, _spz_light, _spz_masonry, spz
from etendue.models._spz_columns import column
from etendue.models.mesh import Mesh, merged
from etendue.models.model import Model

CONFIGS = Path(__file__).parents[2] / "configs"
CONFIG = json.loads((CONFIGS / "a04_spz.json").read_text())


@pytest.fixture(scope="module")
def court() -> Model:
    return spz.atrium()


@pytest.fixture(scope="module")
def lamps(tmp_path_factory: pytest.TempPathFactory) -> Model:
    return _spz_light.light(tmp_path_factory.mktemp("lamps"))


def face_normals(mesh: Mesh) -> np.ndarray:
    p = mesh.vertices[mesh.faces]
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


@dataclass(frozen=True)
class Soup:
    """Every triangle of a model as a corner and two edges."""

    a: np.ndarray
    ab: np.ndarray
    ac: np.ndarray

    def hits(self, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Distances at which a ray crosses the triangles, sorted."""
        h = np.cross(direction, self.ac)
        det = np.einsum("ij,ij->i", h, self.ab)
        det = np.where(np.abs(det) < 1e-14, np.inf, det)
        s = origin - self.a
        u = np.einsum("ij,ij->i", h, s) / det
        q = np.cross(s, self.ab)
        v = (q @ direction) / det
        t = np.einsum("ij,ij->i", q, self.ac) / det
        return np.sort(t[(u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-6)])


@pytest.fixture(scope="module")
def soup(court: Model) -> Soup:
    p = np.concatenate([m.vertices[m.faces] for meshes in court.parts.values() for m in meshes])
    return Soup(p[:, 0], p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def test_has_the_materials_of_the_format_page(court: Model, lamps: Model) -> None:
    names = {*court.parts, *lamps.parts}
    assert names == {*court.materials, *lamps.materials}
    assert names >= {"light.001", "floor.001", *(f"fabric_{letter}.001" for letter in "abcdefg")}
    for word in ("stone", "bricks", "column_a", "arch", "roof", "vase", "chain", "flagpole"):
        assert f"{word}.001" in names
    assert {p["name"] for p in CONFIG["scene"]["materials"]} <= names


def test_naive_twin_differs_in_the_algorithm_alone() -> None:
    other = json.loads((CONFIGS / "a04_spz_naive.json").read_text())
    assert {k: v for k, v in other.items() if v != CONFIG[k]} == {"algorithm": "NaivePathtracer"}


def test_geometry_is_sound(court: Model) -> None:
    assert court.triangle_count > 200_000
    for name, meshes in court.parts.items():
        mesh = merged(meshes)
        assert np.isfinite(mesh.vertices).all()
        # As the file rounds them.
        crossed = face_normals(Mesh(np.round(mesh.vertices, 6), mesh.faces))
        assert (np.linalg.norm(crossed, axis=1) > 1e-11).all(), name
        assert mesh.uvs is not None
        assert np.isfinite(mesh.uvs).all()
        assert all(m.normals is not None for m in meshes)
        assert mesh.normals is not None
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)
        wrong = np.einsum("ij,ij->i", crossed, mesh.normals[mesh.faces].sum(1)) <= 0
        # Where a curtain is tied its folds are crushed.
        assert wrong.mean() < (0.03 if "fabric" in name else 2e-3), name


def test_stays_in_the_frame_of_the_scene(court: Model) -> None:
    vertices = np.concatenate([m.vertices for meshes in court.parts.values() for m in meshes])
    low, high = vertices.min(0), vertices.max(0)
    assert (low > [-20, -0.5, -10]).all()
    assert (high < [18, 16, 10]).all()
    assert (low < [-16, 0.01, -8]).all()
    assert (high > [15, 12, 8]).all()


def test_camera_stands_free_on_the_gallery(soup: Soup) -> None:
    eye, ahead = (np.array(CONFIG["camera"][key]) for key in ("pos", "dir"))
    assert 1.5 < soup.hits(eye, np.array([0.02, -1, 0.3]))[0] < 1.8  # the floor, at eye's height
    assert soup.hits(eye, ahead)[0] > 4
    for sideways in np.eye(3):
        for d in (sideways, -sideways):
            assert soup.hits(eye, d)[:1].min(initial=9) > 0.15


def test_court_is_open_to_the_sun_and_the_galleries_are_not(soup: Soup) -> None:
    sun = _spz_light.SUN / np.linalg.norm(_spz_light.SUN)
    assert len(soup.hits(np.array([4.0, 0.001, -2.7]), sun)) == 0
    for point in ((2.0, 5.2, 7.6), (2.0, 0.3, 7.6), (15.0, 5.2, -7.5)):
        assert len(soup.hits(np.array(point), sun)) > 0
        assert len(soup.hits(np.array(point), np.array([0.01, 1.0, 0.02]))) > 0


def test_lamps_shine_on_the_court(lamps: Model) -> None:
    for name in ("light.001", "sky_light.001"):
        mesh = merged(lamps.parts[name])
        assert (np.linalg.norm(face_normals(mesh), axis=1) > 1e-3).all()
        p = mesh.vertices[mesh.faces].mean(1)
        assert (np.einsum("ij,ij->i", face_normals(mesh), np.array([0, 5, 0]) - p) > 0).all()
        assert (p[:, 1] > (5 if name == "light.001" else 0)).all()
    assert lamps.materials["light.001"].kd == (1.0, 0.9, 0.8)


def test_columns_and_links_are_whole() -> None:
    for mesh in (column(2.65, 0.2), column(2.2, 0.165, 20), _spz_garden._chain(0.4), _spz_kit.block(1, 2, 3)):
        volume = np.einsum("ij,ij->", mesh.vertices[mesh.faces[:, 0]], face_normals(mesh)) / 6
        assert volume > 0
    block = _spz_kit.block(1, 2, 3, 0.05)
    assert len(block.faces) == 44
    assert np.einsum("ij,ij->", block.vertices[block.faces[:, 0]], face_normals(block)) / 6 == pytest.approx(
        6, rel=0.01
    )


def test_is_the_same_every_time(court: Model, tmp_path: Path) -> None:
    again = spz.atrium()
    assert list(again.parts) == list(court.parts)
    for name, meshes in court.parts.items():
        for a, b in zip(meshes, again.parts[name], strict=True):
            assert np.array_equal(a.vertices, b.vertices)
            assert np.array_equal(a.faces, b.faces)
    for folder in ("a", "b"):
        _spz_masonry.wood(tmp_path / folder)
        _spz_fabrics.leaves(tmp_path / folder)
    for path in sorted((tmp_path / "a").iterdir()):
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_leaves_are_cut_out(tmp_path: Path) -> None:
    import OpenImageIO as oiio

    _spz_fabrics.leaves(tmp_path, 128)
    mask = np.asarray(oiio.ImageBuf(str(tmp_path / "leaves_mask.png")).get_pixels(oiio.FLOAT))
    assert 0.15 < mask.mean() < 0.6
    assert set(np.unique(mask)) == {0.0, 1.0}


def test_every_picture_is_painted(court: Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spz, "atrium", lambda: Model(materials=court.materials))
    spz.build(tmp_path)
    for mtl in (tmp_path / "sponza" / "sponza_base.mtl", tmp_path / "sponza" / "sponza_light.mtl"):
        maps = [line.split()[1] for line in mtl.read_text().splitlines() if line.startswith("map_")]
        assert maps
        assert all((mtl.parent / name).is_file() for name in maps)
    assert {p.as_posix() for p in (Path("sponza/sponza_base.obj"), Path("sponza/sponza_light.obj"))} == set(
        SCENES["spz"]
    )
