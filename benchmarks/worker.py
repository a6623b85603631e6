r"""One renderer in a process of its own: reads commands, a JSON object a line, and answers alike.

python -m benchmarks.worker MODULE WORLD \
    '{"width": ..., "height": ..., "threads": ..., "uncoated": false, "options": {...}}'
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import sys
import time
from pathlib import Path

import numpy as np

from .world import World


def main() -> None:
    """Builds the scene, then renders whenever it is told to; ends with its input."""
    # Some renderers print where the answers go.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    module, path, settings = sys.argv[1], Path(sys.argv[2]), json.loads(sys.argv[3])

    def answer(**values: object) -> None:
        print(json.dumps(values), file=answers)

    world = World.read(path)
    if settings.pop("uncoated"):
        world = world.uncoated()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    backend = importlib.import_module(f"benchmarks.renderers.{module}")
    start = time.perf_counter()
    renderer = backend.Renderer(world, **settings)
    answer(build_seconds=time.perf_counter() - start)
    for line in sys.stdin:
        command = json.loads(line)
        start, cpu = time.perf_counter(), time.process_time()
        image = renderer.render(command["spp"], command["seed"])
        seconds, cpu = time.perf_counter() - start, time.process_time() - cpu
        np.save(command["out"], np.asarray(image, np.float32))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        answer(
            seconds=seconds, cpu_seconds=cpu, rays=renderer.rays, peak_mb=peak / 1024, before_mb=before / 1024
        )


if __name__ == "__main__":
    main()
