"""The renderers that are compared, each in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parent.parent
#: made by `python -m benchmarks install-peers`
PEERS = ROOT / "build" / "benchmarks" / "peers"

_ALONE: dict[str, Any] = dict.fromkeys(("path_reuse", "light_tracing", "light_splitting", "portals"), False)
#: by name: the module in renderers/, and its options
CONTESTANTS: dict[str, tuple[str, dict[str, Any]]] = {
    "etendue": ("etendue", {}),
    "etendue-1-thread": ("etendue", {"threads": 1}),
    "etendue-alone": ("etendue", _ALONE),
    # The estimator that Mitsuba has: lights are chosen from everywhere alike.
    "etendue-plain": ("etendue", _ALONE | {"light_choice": "power"}),
    "mitsuba-llvm": ("mitsuba", {"variant": "llvm_ad_rgb"}),
    "mitsuba-scalar": ("mitsuba", {"variant": "scalar_rgb"}),
    "cycles": ("cycles", {}),
    "luxcore": ("luxcore", {}),
}


class Absent(Exception):
    """A contestant that cannot run here; says why."""


def install_peers() -> None:
    """A virtual environment with the peers, whose dependencies contradict Étendue's."""
    subprocess.run([sys.executable, "-m", "venv", "--clear", PEERS], check=True)
    requirements = Path(__file__).with_name("requirements.txt")
    subprocess.run([PEERS / "bin" / "pip", "install", "--requirement", requirements], check=True)


class Contestant:
    """A renderer with a world loaded; `close` ends its process."""

    def __init__(
        self,
        name: str,
        world: Path,
        size: int,
        threads: int,
        options: dict[str, Any] | None = None,
        environment: dict[str, str] | None = None,
    ) -> None:
        module, own = CONTESTANTS[name]
        given = {**own, **(options or {})}
        python = sys.executable if module == "etendue" else str(PEERS / "bin" / "python")
        if not Path(python).exists():
            raise Absent(f"{name}: not installed; python -m benchmarks install-peers")
        settings = {
            "width": size,
            "height": size,
            "threads": given.pop("threads", threads),
            "uncoated": given.pop("uncoated", False),
            "options": given,
        }
        self.name = name
        self.peak_mb = 0.0
        self.rays: int | None = None
        self._folder = tempfile.TemporaryDirectory()
        self._out = Path(self._folder.name) / "image.npy"
        self._log = Path(self._folder.name) / "log"
        with self._log.open("w") as log:
            self._process = subprocess.Popen(
                [python, "-m", "benchmarks.worker", module, str(world), json.dumps(settings)],
                cwd=ROOT,
                env={**os.environ, **(environment or {})},
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
            )
        self.build_seconds = float(self._answer()["build_seconds"])

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            said = [text for text in self._log.read_text().splitlines() if text.strip()]
            raise Absent(f"{self.name}: {said[-1] if said else 'ended without a word'}")
        return dict(json.loads(line))

    def render(self, spp: int, seed: int) -> tuple[float, float, NDArray[np.float32]]:
        """Seconds, seconds of the processor over all threads, and the image."""
        assert self._process.stdin is not None
        print(
            json.dumps({"spp": spp, "seed": seed, "out": str(self._out)}),
            file=self._process.stdin,
            flush=True,
        )
        answer = self._answer()
        self.peak_mb, self.rays = answer["peak_mb"], answer["rays"]
        return answer["seconds"], answer["cpu_seconds"], np.load(self._out)

    def close(self) -> None:
        """Ends the process."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait(timeout=60)
        self._folder.cleanup()
