"""Fuzz the readers of files with coverage as the guide: python -m tests.fuzz [--minutes 60] [TARGET ...]

Needs the extra `fuzz`. Each target gets an equal share of the time. Inputs that break the promise are kept in
build/fuzz/TARGET/, one for each way of breaking it, with the traceback beside; exit code 1 where there are any.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

from .formats import TARGETS

FOLDER = Path(__file__).resolve().parents[2] / "build" / "fuzz"
# Python that reads files; libFuzzer's own limits are wider than those of limits.py.
INSTRUMENTED = ["etendue", "trimesh"]
LIBFUZZER = ["-timeout=30", "-rss_limit_mb=4096", "-max_len=20000", "-print_final_stats=1", "-verbosity=0"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)}; all by default"
    )
    parser.add_argument("--minutes", type=float, default=60, help="for all targets together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    targets = arguments.targets or list(TARGETS)
    unknown = set(targets) - set(TARGETS)
    if unknown:
        parser.error(f"no such target: {', '.join(sorted(unknown))}")
    if importlib.util.find_spec("atheris") is None:
        parser.error("atheris is not installed; pip install -e '.[fuzz]' does that")
    if arguments.inside:
        fuzz(targets[0], arguments.minutes * 60, arguments.seed)
    seconds = arguments.minutes * 60 / len(targets)
    return max([supervise(target, seconds, arguments.seed) for target in targets])


def supervise(target: str, seconds: float, seed: int) -> int:
    """Fuzz in a process of its own, and again where that ended early; 1 where anything was found."""
    folder = FOLDER / target
    folder.mkdir(parents=True, exist_ok=True)
    end = time.monotonic() + seconds
    executions, deaths = 0, 0
    while (left := end - time.monotonic()) > 2:
        command = [sys.executable, "-m", "tests.fuzz", "--inside", target]
        command += ["--minutes", str(left / 60), "--seed", str(seed + deaths)]
        done = subprocess.run(
            command, cwd=FOLDER.parents[1], capture_output=True, text=True, errors="replace"
        )
        executions += count(done.stderr)
        if done.returncode:
            deaths += 1
            (folder / f"death-{deaths}.log").write_text(done.stdout[-5000:] + done.stderr[-20000:])
            if deaths > 20:
                break
    found = sorted(path.name for path in folder.glob("broken-*.txt"))
    print(
        f"{target}: {executions} executions in {seconds:.0f} s; {len(found)} ways to break, {deaths} deaths"
    )
    for name in found:
        print(f"    {(folder / name).read_text().splitlines()[0]}  ({folder / name})")
    return int(bool(found) or deaths > 0)


def count(log: str) -> int:
    """Executions that libFuzzer reports."""
    lines = [line for line in log.splitlines() if "number_of_executed_units" in line]
    return int(lines[-1].split()[-1]) if lines else 0


def fuzz(name: str, seconds: float, seed: int) -> None:
    """Never returns: libFuzzer ends the process."""
    import atheris

    with atheris.instrument_imports(include=INSTRUMENTED):
        import trimesh.exchange.gltf
        import trimesh.exchange.ply
        import trimesh.exchange.stl  # noqa: F401

        import etendue.loaders.gltf
        import etendue.loaders.obj
        import etendue.loaders.other
        import etendue.scene.parts  # noqa: F401

        from . import seeds
        from .targets import Broken, Target
    folder = FOLDER / name
    corpus, words = folder / "corpus", folder / "words.txt"
    corpus.mkdir(exist_ok=True)
    for data in seeds.corpus(name):
        (corpus / hashlib.sha1(data).hexdigest()).write_bytes(data)
    escaped = ["".join(f"\\x{byte:02x}" for byte in word) for word in seeds.WORDS[name]]
    words.write_text("".join(f'"{word}"\n' for word in escaped))
    target = Target(name).__enter__()

    def once(data: bytes) -> None:
        try:
            target(data)
        except Broken as error:
            keep(folder, data, error)

    limits = [f"-max_total_time={max(int(seconds), 1)}", f"-seed={seed}", f"-dict={words}"]
    os.chdir(target.folder)
    atheris.Setup([sys.argv[0], *LIBFUZZER, *limits, str(corpus)], once)
    atheris.Fuzz()


def keep(folder: Path, data: bytes, error: BaseException) -> None:
    """The input and its traceback, once for each place in the code and kind of error."""
    cause = error.__cause__ or error
    frames = traceback.extract_tb(cause.__traceback__)
    frames += traceback.extract_tb(cause.__cause__.__traceback__) if cause.__cause__ else []
    place = f"{Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "nowhere"
    key = hashlib.sha1(f"{type(cause).__name__} {place}".encode()).hexdigest()[:8]
    if not (folder / f"broken-{key}.txt").exists():
        (folder / f"broken-{key}.bin").write_bytes(data)
        text = f"{error} at {place}".replace("\n", " ")
        (folder / f"broken-{key}.txt").write_text(text + "\n\n" + "".join(traceback.format_exception(cause)))


if __name__ == "__main__":
    sys.exit(main())
