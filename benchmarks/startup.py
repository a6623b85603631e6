"""How long a user waits before anything is rendered."""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .scenes import ROOT

_COMMANDS = {
    "python -c pass": ["-c", "pass"],
    "import etendue": ["-c", "import etendue"],
    "etendue --help": ["-m", "etendue", "--help"],
    "render of the box, 64 x 64, 1 spp": [
        *("-m", "etendue", "render", "configs/a04_box.json", "--size", "64x64", "--spp", "1", "-o")
    ],
}


def measure(repeats: int) -> dict[str, dict[str, float]]:
    """By command the median and the least seconds, and the median seconds of the processor."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in _COMMANDS.items():
            wall, cpu = [], []
            command = [sys.executable, *arguments]
            if arguments[-1] == "-o":
                command.append(str(Path(folder) / "box.exr"))
            for _ in range(repeats):
                before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
                subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
                wall.append(time.perf_counter() - start)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                cpu.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
            found[name] = {
                "median": statistics.median(wall),
                "least": min(wall),
                "processor": statistics.median(cpu),
            }
    return found
