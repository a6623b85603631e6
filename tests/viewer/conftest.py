"""A screen without a machine to show it: Xvfb, with OpenGL in software."""

from __future__ import annotations

import os
import select
import shutil
import subprocess
import sys
from collections.abc import Iterator

import pytest

if sys.version_info < (3, 11):
    collect_ignore_glob = ["test_*.py"]  # Dear ImGui's package is not made for it


@pytest.fixture(scope="session")
def screen() -> Iterator[str]:
    """The name of a display of 1280 x 800 pixels, which $DISPLAY is set to."""
    program = shutil.which("Xvfb")
    assert program, "Xvfb is missing; ./test installs it"
    reading, writing = os.pipe()
    server = subprocess.Popen(
        [program, "-displayfd", str(writing), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    # One thread draws; the others are left to what is tested.
    drawing = {"LIBGL_ALWAYS_SOFTWARE": "1", "LP_NUM_THREADS": "1"}
    before = {name: os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", *drawing)}
    try:
        ready, _, _ = select.select([reading], [], [], 60)
        number = os.read(reading, 16).decode().strip() if ready else ""
        assert number, "Xvfb does not start"
        os.environ.update(DISPLAY=f":{number}", **drawing)
        os.environ.pop("WAYLAND_DISPLAY", None)
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()
        os.close(reading)
        for name, value in before.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value
