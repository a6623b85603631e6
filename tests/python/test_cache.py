"""What is kept of files: the same as read from them, never of a file that has changed, and nothing where it fails."""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import etendue
from etendue.errors import EtendueError
from etendue.film.fingerprint import of_meshes
from etendue.loaders import MeshFile, cache, image, load_image, load_mesh, obj, obj_text

# Something to be said of every line but those of the square.
OBJ = """mtllib square.mtl
mtllib elsewhere.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt nan 0
vt 1 1
vn 0 0 1
vn 0 1 1
usemtl red
f 1/1/1 2/2/2 3/3/1
usemtl grün
f 1 3 4
f 1 1 2
f 1 2
what is this
"""
MTL = "newmtl red\nKd 1 0 0\nmap_Kd red.png\n"
Loaded = tuple[MeshFile, list[str]]


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "cache"))
    monkeypatch.delenv(cache.VARIABLE, raising=False)
    # These files are small, and were written just now.
    monkeypatch.setattr(obj, "_LARGE", 0)
    monkeypatch.setattr(image, "_LARGE_FILE", 0)
    monkeypatch.setattr(cache, "_UNSURE", 0)
    Path("square.obj").write_text(OBJ)
    Path("square.mtl").write_text(MTL)
    picture("red.png", np.full((2, 2, 3), 128, np.uint8))


def tick() -> None:
    """Whatever is written from here on has another time stamp, as the system counts in steps of milliseconds."""
    time.sleep(0.02)


def picture(name: str, pixels: np.ndarray) -> None:
    target = oiio.ImageOutput.create(name)
    height, width, channels = pixels.shape
    kind = oiio.UINT8 if pixels.dtype == np.uint8 else oiio.FLOAT
    assert target.open(name, oiio.ImageSpec(width, height, channels, kind))
    assert target.write_image(pixels)
    assert target.close()


def read(name: str = "square.obj") -> Loaded:
    warnings: list[str] = []
    return load_mesh(name, warnings), warnings


def entries() -> list[Path]:
    return sorted(cache.folder().iterdir()) if cache.folder().is_dir() else []


def is_same(a: Loaded, b: Loaded) -> bool:
    """All but whether the digest is known."""

    def plain(loaded: Loaded) -> Any:
        file, warnings = loaded
        meshes = [
            [value if not isinstance(value, np.ndarray) else (value.dtype, value.shape, value.tobytes())]
            for mesh in file.meshes
            for value in vars(mesh).values()
        ]
        return file.path, meshes, file.materials, warnings

    return bool(plain(a) == plain(b))


@pytest.fixture
def parses(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Every file whose text is read from here on."""
    found: list[Path] = []
    original = obj_text.read
    monkeypatch.setattr(obj_text, "read", lambda path: found.append(path) or original(path))
    return found


def test_what_is_kept_is_what_was_read(monkeypatch: pytest.MonkeyPatch, parses: list[Path]) -> None:
    monkeypatch.setenv(cache.VARIABLE, "0")
    without = read()
    assert not entries()
    assert len(without[1]) == 5
    monkeypatch.delenv(cache.VARIABLE)
    first = read()
    assert len(parses) == 2
    kept = read()
    assert len(parses) == 2
    assert is_same(without, first)
    assert is_same(without, kept)
    assert first[0].digest == kept[0].digest == of_meshes(without[0].meshes)
    # Told by the name that is asked for.
    absolute, warnings = read(str(Path("square.obj").resolve()))
    assert absolute.path.is_absolute()
    assert warnings[0] == f"{absolute.path}{without[1][0].removeprefix('square.obj')}"
    assert len(parses) == 2


def test_an_edited_file_is_read_anew(parses: list[Path]) -> None:
    file = Path("square.obj")
    before, info = read(), file.stat()
    tick()
    # As long as before, the same inode, and with the time stamp put back.
    with file.open("r+") as stream:
        stream.write(OBJ.replace("v 1 1 0", "v 1 2 0"))
    os.utime(file, ns=(info.st_atime_ns, info.st_mtime_ns))
    assert (file.stat().st_size, file.stat().st_mtime_ns) == (info.st_size, info.st_mtime_ns)
    after = read()
    assert not is_same(before, after)
    assert after[0].meshes[0].vertices.max() == 2
    assert is_same(after, read())
    assert len(parses) == 2


def test_an_edited_material_file_is_noticed(parses: list[Path]) -> None:
    assert read()[0].materials[0].albedo == (1, 0, 0)
    Path("square.mtl").write_text(MTL.replace("1 0 0", "0 1 0").replace("red.png", "no.png"))
    file, warnings = read()
    assert file.materials[0].albedo == (0, 1, 0)
    assert any("there is no texture no.png" in warning for warning in warnings)
    Path("elsewhere.mtl").write_text("newmtl grün\nKd 0 0 1\n")
    assert read()[0].materials[1].albedo == (0, 0, 1)
    assert len(parses) == 1


def test_an_edited_image_is_noticed() -> None:
    assert load_image("red.png").pixels[0, 0, 0] == 128
    (entry,) = entries()
    assert load_image("red.png").pixels[0, 0, 0] == 128
    tick()
    picture("red.png", np.full((2, 2, 3), 64, np.uint8))
    assert load_image("red.png").pixels[0, 0, 0] == 64
    assert entries() == [entry]


@pytest.mark.parametrize("kind", ["colour", "linear", "normal", "environment"])
def test_an_image_is_kept_for_each_use(kind: image.Kind) -> None:
    pixels = np.full((4, 8, 3), [0.5, -1, np.inf], np.float32)
    picture("sky.exr", pixels)
    for other in ("colour", "linear", "normal", "environment"):
        load_image("sky.exr", other)  # type: ignore[arg-type]
    assert len(entries()) == 4
    said: list[str] = []
    kept = load_image("sky.exr", kind, said)
    direct_said: list[str] = []
    direct = image._image(Path("sky.exr"), kind, direct_said)
    assert (kept.srgb, kept.path, said) == (direct.srgb, direct.path, direct_said)
    assert kept.pixels.dtype == direct.pixels.dtype
    assert np.array_equal(kept.pixels, direct.pixels)
    assert len(said) == (kind == "environment")


def _flipped(where: float) -> Callable[[bytes], bytes]:
    def flip(data: bytes) -> bytes:
        at = int(where * (len(data) - 1))
        return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]

    return flip


@pytest.mark.parametrize(
    "damage",
    [
        lambda _: b"",
        lambda _: b"\n",
        lambda data: data[:-1],
        lambda data: data[: len(data) // 2],
        lambda data: data[:20],
        lambda data: data + b"\0",
        lambda data: data[: len(data) // 2] + bytes(len(data) - len(data) // 2),
        *map(_flipped, np.linspace(0, 1, 12).tolist()),
    ],
)
def test_a_damaged_entry_is_made_anew(damage: Callable[[bytes], bytes], parses: list[Path]) -> None:
    good = read()
    (entry,) = entries()
    content = entry.read_bytes()
    entry.write_bytes(damage(content))
    assert is_same(read(), good)
    assert len(parses) == 2
    assert entry.read_bytes() == content
    assert is_same(read(), good)
    assert len(parses) == 2


def test_other_loaders_read_anew(monkeypatch: pytest.MonkeyPatch, parses: list[Path]) -> None:
    read()
    monkeypatch.setattr(cache, "_version", lambda: "another")
    read()
    assert len(parses) == 2


def test_a_folder_that_can_only_be_read(monkeypatch: pytest.MonkeyPatch, parses: list[Path]) -> None:
    good = read()

    def refused(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, "read-only")

    monkeypatch.setattr(os, "utime", refused)
    assert is_same(read(), good)
    assert len(parses) == 1


def test_what_is_done_to_arrays_is_not_kept() -> None:
    good, _ = read(), read()[0].meshes[0].vertices.fill(7)
    read()[0].meshes[0].vertices.fill(7)
    assert is_same(read(), good)


def test_nothing_is_kept_where_nothing_can_be_written(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "square.obj" / "no folder"))
    good = read()
    assert is_same(read(), good)
    assert cache.size() == 0
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "full"))

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "no space left")

    monkeypatch.setattr(os, "replace", full)
    assert is_same(read(), good)
    assert not entries()


def test_a_file_that_may_change_unseen_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "_UNSURE", 60_000_000_000)
    read()
    assert not entries()
    monkeypatch.setattr(cache, "_UNSURE", 0)
    original = obj_text.read

    def changing(path: Path) -> obj_text.ObjText:
        found = original(path)
        path.write_text(OBJ.replace("v 1 1 0", "v 1 22 0"))
        return found

    monkeypatch.setattr(obj_text, "read", changing)
    read()
    assert not entries()


def test_many_at_once() -> None:
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda _: read(), range(32)))
    assert all(is_same(one, found[0]) for one in found)
    assert len(entries()) == 1


def test_what_was_used_last_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    entry_of: dict[str, Path] = {}

    def load(name: str) -> None:
        before = entries()
        picture(name, np.full((256, 128, 3), 0.5, np.float32))
        load_image(name)
        (entry_of[name],) = set(entries()) - set(before)

    for age, name in enumerate(("first.exr", "second.exr", "third.exr")):
        load(name)
        os.utime(entry_of[name], ns=(0, age))
    load_image("first.exr")
    # One is larger than a third of a megabyte.
    monkeypatch.setenv(cache.VARIABLE, "1")
    load("fourth.exr")
    assert cache.size() <= 1 << 20
    assert set(entries()) == {entry_of["first.exr"], entry_of["fourth.exr"]}
    picture("large.exr", np.full((512, 512, 3), 0.5, np.float32))
    load_image("large.exr")
    assert set(entries()) == {entry_of["first.exr"], entry_of["fourth.exr"]}


def test_a_limit_that_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.VARIABLE, "-1")
    with pytest.raises(
        EtendueError, match=r"ETENDUE_FILE_CACHE: a number of megabytes is needed \(0: no cache\)"
    ):
        read()


def test_the_picture_and_the_scene_are_the_same(
    lit_scene: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    picture("grain.png", np.random.default_rng(1).integers(0, 255, (16, 16, 3), np.uint8))
    mesh = Path("lit.obj").read_text().replace("f 4 3 2", "vt 0 0\nvt 1 0\nvt 1 1\nf 4/1 3/2 2/3")
    Path("lit.obj").write_text(mesh)
    Path("lit.mtl").write_text(
        Path("lit.mtl").read_text().replace("newmtl light", "map_Kd grain.png\nnewmtl light")
    )
    lit_scene()
    monkeypatch.setenv(cache.VARIABLE, "0")
    films = [etendue.load("lit.json").render()]
    monkeypatch.delenv(cache.VARIABLE)
    films += [etendue.load("lit.json").render() for _ in range(2)]
    assert len(entries()) == 2
    for film in films[1:]:
        assert film.image.tobytes() == films[0].image.tobytes()
        assert film.origin is not None
        assert film.origin == films[0].origin
