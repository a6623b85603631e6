"""Output files: refused early, written whole."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from etendue import outputs
from etendue.errors import EtendueError


def refusal(*paths: str | Path) -> str:
    with pytest.raises(EtendueError) as caught:
        outputs.check(paths)
    return str(caught.value)


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_good_paths_leave_no_trace(tmp_path: Path) -> None:
    Path("old.png").write_text("old")
    assert outputs.check(["a.exr", "old.png", "b.JPG", "a.exr"]) == [
        Path("a.exr"),
        Path("old.png"),
        Path("b.JPG"),
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["old.png"]
    assert Path("old.png").read_text() == "old"


def test_unknown_extensions() -> None:
    allowed = "allowed: .exr, .hdr, .png, .jpg, .jpeg"
    assert refusal("a.tif") == f'a.tif: no image can be written as ".tif" ({allowed})'
    assert refusal("a.pgn") == f'a.pgn: no image can be written as ".pgn" (did you mean ".png"? {allowed})'
    assert refusal("a") == f"a: the extension is missing ({allowed})"


def test_places_that_cannot_be_written() -> None:
    Path("folder.png").mkdir()
    Path("file").touch()
    assert refusal("folder.png") == "folder.png: cannot be written: it is a folder"
    assert refusal("none/a.png") == "none/a.png: cannot be written: there is no folder none"
    assert refusal("file/a.png") == "file/a.png: cannot be written: there is no folder file"
    assert refusal(f"{'a' * 300}.png").endswith(".png: cannot be written: File name too long")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder that nobody may write to")
def test_a_folder_without_permission() -> None:
    assert refusal("/proc/a.png").startswith("/proc/a.png: cannot be written: ")


def test_all_refusals_at_once() -> None:
    assert refusal("a.tif", "none/a.png").split("\n") == [refusal("a.tif"), refusal("none/a.png")]


def test_a_file_appears_whole_with_ordinary_permissions() -> None:
    outputs.write(Path("a.png"), lambda path: path.write_text(f"written as {path.suffix}"))
    assert Path("a.png").read_text() == "written as .png"
    Path("b.png").touch()
    assert os.stat("a.png").st_mode == os.stat("b.png").st_mode


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    Path("a.png").write_text("old")

    def fail(path: Path) -> None:
        path.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(EtendueError) as caught:
        outputs.write(Path("a.png"), fail)
    assert str(caught.value) == "a.png: cannot be written: No space left on device"
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]
    assert Path("a.png").read_text() == "old"


def test_a_link_is_followed() -> None:
    Path("real").mkdir()
    Path("link.png").symlink_to("real/a.png")
    outputs.write(Path("link.png"), lambda path: path.write_text("new"))
    assert Path("link.png").is_symlink()
    assert Path("real/a.png").read_text() == "new"
