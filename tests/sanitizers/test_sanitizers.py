"""The core built with sanitizers: memory and undefined behaviour under the fast tests, races under a driver."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import etendue

from .. import builds
from ..builds import ROOT

HERE = Path(__file__).parent
# Fast tests that between them reach all of the core; clocks mean nothing in this build.
FAST = (
    "tests/estimators/test_analytic.py",
    "tests/estimators/test_invariance.py",
    "tests/estimators/test_light_splitting.py",
    "tests/estimators/test_light_tracing.py",
    "tests/estimators/test_portals.py",
    "tests/statistics/test_bsdf_edges.py",
)
CHOSEN = (
    "not mean_stays and ((furnace and not 200) or glass or mirrors or sky or threads or steps or keeps_what"
    " or instrumented or edges or pieces or are_taken)"
)

pytestmark = pytest.mark.slow


def build(name: str, sanitizers: str, target: str) -> Path:
    """The folder of a build with these sanitizers; made, or brought up to date."""
    return builds.build(ROOT / "build" / name, target, f"-DETENDUE_SANITIZE={sanitizers}")


def library(name: str) -> str:
    """Where the compiler keeps a sanitizer's library."""
    where = subprocess.run(["c++", f"-print-file-name={name}"], capture_output=True, text=True, check=True)
    return where.stdout.strip()


def run(*command: str | Path, **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=ROOT,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        errors="replace",
    )
    output = done.stdout + done.stderr
    if done.returncode or "runtime error:" in output or "Sanitizer:" in output:
        pytest.fail(f"exit code {done.returncode}:\n{output[-8000:]}", pytrace=False)
    return output


def test_memory_and_undefined_behaviour(tmp_path: Path) -> None:
    """ASan and UBSan over the fast tests of the core; leaks left aside, as Python's own would drown ours."""
    folder = build("asan", "address,undefined", "_core")
    module = next(folder.glob("_core*.so"))
    # The installed package finds its compiled core by a path that a plugin, loaded before any test, overrules.
    (tmp_path / "instrumented.py").write_text(
        "import importlib.util, sys\n"
        f"spec = importlib.util.spec_from_file_location('etendue._core', {str(module)!r})\n"
        "core = importlib.util.module_from_spec(spec)\n"
        "sys.modules['etendue._core'] = core\n"
        "spec.loader.exec_module(core)\n"
        "import etendue\n"
        "etendue._core = core\n"
    )
    output = run(
        *(sys.executable, "-m", "pytest", "-p", "instrumented", "-p", "no:cacheprovider", "-p", "no:xdist"),
        *("-q", "-x", "-s", "-k", CHOSEN, "--junitxml", tmp_path / "report.xml", *FAST, HERE / "edges.py"),
        LD_PRELOAD=f"{library('libasan.so')} {library('libubsan.so')} {library('libstdc++.so.6')}",
        ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=1",
        UBSAN_OPTIONS="print_stacktrace=1",
        PYTHONPATH=os.pathsep.join([str(tmp_path), str(Path(etendue.__file__).parents[1])]),
        PYTHONMALLOC="malloc",
        ETENDUE_CORE=str(module),
    )
    assert " passed" in output


def test_races() -> None:
    """TSan over the driver: threads, progress, cancelling, invalid samples, two renders of one scene."""
    folder = build("tsan", "thread", "driver_tsan")
    output = run(folder / "driver_tsan", TSAN_OPTIONS=f"suppressions={HERE / 'tsan.supp'}")
    assert "driver: ok" in output
