"""Format and style of the sources, as tests, so that one summary tells everything that is wrong."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
CPP = sorted(path for path in (ROOT / "src").rglob("*") if path.suffix in {".cpp", ".h"})


def check(*command: str | Path) -> None:
    done = subprocess.run(
        [str(part) for part in command], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode:
        pytest.fail(f"{Path(command[0]).name}:\n{done.stdout}", pytrace=False)


def tool(name: str) -> Path:
    """A program of the environment that runs the tests: its version decides what is well formatted."""
    path = Path(sys.executable).parent / name
    if not path.exists():
        pytest.fail(f"{name} is missing; ./test installs it", pytrace=False)
    return path


def git(*arguments: str) -> str | None:
    if not shutil.which("git"):
        return None
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def changed_cpp_files() -> list[Path]:
    """Sources that changed, or a header of theirs, since this branch left main.

    On main itself, since the commit before; all of them where git cannot tell.
    """
    sources = [path for path in CPP if path.suffix == ".cpp"]
    head, fork = git("rev-parse", "HEAD"), git("merge-base", "HEAD", "origin/main")
    base = git("rev-parse", "--verify", "--quiet", "HEAD~") if fork in (None, head) else fork
    changed = git("diff", "--name-only", base, "--", "src") if base else None
    if changed is None:
        return sources
    new = git("ls-files", "--others", "--exclude-standard", "src") or ""
    names = {Path(line).name for line in (changed + "\n" + new).splitlines()}
    return [path for path in sources if names & {path.name, *included_names(path)}]


def included_names(source: Path) -> set[str]:
    return {
        name.rpartition("/")[2]
        for name in re.findall(r'^#include "([^"]+)"', source.read_text(), re.MULTILINE)
    }


def test_cpp_format() -> None:
    check(tool("clang-format"), "--dry-run", "-Werror", *CPP)


def test_python_format() -> None:
    check(tool("ruff"), "format", "--check", "--output-format=concise")


def test_python_style() -> None:
    check(tool("ruff"), "check", "--quiet", "--output-format=concise")


def test_python_types() -> None:
    check(tool("mypy"), "--no-error-summary")


@pytest.mark.parametrize("source", changed_cpp_files(), ids=lambda path: str(path.relative_to(ROOT)))
def test_cpp_style(source: Path) -> None:
    databases = sorted(
        (ROOT / "build").glob("**/compile_commands.json"), key=lambda file: file.stat().st_mtime
    )
    if not databases:
        pytest.skip("no compile_commands.json: nothing was built here")
    check(tool("clang-tidy"), "--quiet", "--warnings-as-errors=*", "-p", databases[-1].parent, source)
