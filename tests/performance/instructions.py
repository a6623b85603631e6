"""Instructions per sample, counted by Callgrind: timings vary from minute to minute, counts do not.

After a change that is worth its instructions, write the new counts down:

    python -m tests.performance.instructions
"""

from __future__ import annotations

import functools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests import builds

from .tiny import SIZE

HERE = Path(__file__).resolve().parent
COUNTS = HERE / "counts.json"
SCENES = ("box", "sky")
#: the counts of a render with more samples, less those with fewer: what Python does falls out
FEW, MANY = 4, 132


def obstacle() -> str | None:
    """Why nothing can be counted here."""
    if shutil.which("valgrind") is None:
        return "valgrind is not installed"
    info = Path("/proc/cpuinfo")
    if not info.exists() or "avx2" not in info.read_text().split():
        return "the counts are those of processors with AVX2"
    return None


@functools.cache
def _core() -> Path:
    """A build for every processor with AVX2: the same instructions wherever they are counted."""
    folder = builds.ROOT / "build" / "instructions"
    options = ("-DETENDUE_NATIVE=OFF", "-DCMAKE_CXX_FLAGS=-march=x86-64-v3")
    return builds.core_in(builds.build(folder, "_core", *options))


def _count(scene: str, spp: int) -> int:
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", sys.executable,
             "-m", "tests.performance.tiny", scene, str(spp)],
            cwd=builds.ROOT,
            env={**os.environ, "PYTHONHASHSEED": "0", "ETENDUE_BENCHMARK_CORE": str(_core())},
            capture_output=True,
            text=True,
        )  # fmt: skip
    found = re.search(r"Collected\s*:\s*(\d+)", done.stderr)
    if done.returncode or found is None:
        raise RuntimeError(done.stderr[-2000:])
    return int(found[1])


def per_sample(scene: str) -> float:
    """Of the whole process, Embree included, for one sample more."""
    return (_count(scene, MANY) - _count(scene, FEW)) / (SIZE * SIZE * (MANY - FEW))


def known() -> dict[str, float]:
    return dict(json.loads(COUNTS.read_text()))


if __name__ == "__main__":
    COUNTS.write_text(json.dumps({scene: round(per_sample(scene)) for scene in SCENES}, indent=2) + "\n")
    print(COUNTS.read_text(), end="")
