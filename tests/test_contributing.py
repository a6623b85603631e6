"""The examples of CONTRIBUTING.md compile as they stand there, and are formatted as they ask others to be."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "CONTRIBUTING.md").read_text()
# A block of C++ belongs to the file that the text before it names last.
EXAMPLES = {
    re.findall(r"`(src/[\w/]+\.(?:cpp|h))`", TEXT[: block.start()])[-1]: block.group(1)
    for block in re.finditer(r"```cpp\n(.*?)```", TEXT, re.DOTALL)
}


def run(command: list[str], folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        pytest.fail(done.stdout, pytrace=False)


def test_there_are_examples() -> None:
    assert {str(Path(name).parent) for name in EXAMPLES} == {
        "src/algorithms",
        "src/gi/bsdfs",
        "src/gi/lights",
    }


# A BSDF's functions are templates, which compile only once they are used.
USES = """
#include "{name}"
using namespace etendue;
template vec3 {type}::f(const Surface&, const vec3&, const vec3&);
template float {type}::pdf(const Surface&, const vec3&, const vec3&);
template BsdfSample {type}::sample(const Surface&, const vec3&, const float&, const vec2&);
using LaneSurface = SurfaceOf<Lanes>;
template LaneVec3 {type}::f(const LaneSurface&, const LaneVec3&, const LaneVec3&);
template Lanes {type}::pdf(const LaneSurface&, const LaneVec3&, const LaneVec3&);
template BsdfSampleOf<Lanes> {type}::sample(const LaneSurface&, const LaneVec3&, const Lanes&, const LaneVec2&);
"""


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_compiles(name: str, tmp_path: Path) -> None:
    databases = sorted(
        (ROOT / "build").glob("*/compile_commands.json"), key=lambda file: file.stat().st_mtime
    )
    if not databases:
        pytest.skip("no compile_commands.json: nothing was built here")
    entries = json.loads(databases[-1].read_text())
    like = next(entry for entry in entries if entry["file"].endswith("src/algorithms/algorithm.cpp"))
    flags = [flag for flag in shlex.split(like["command"]) if flag.startswith(("-I", "-D", "-std", "-W"))]
    compiler = shlex.split(like["command"])[0]
    source = tmp_path / Path(name).name
    source.write_text(EXAMPLES[name])
    if Path(name).parent.name == "bsdfs":
        (bsdf,) = re.findall(r"struct (\w+) : Bsdf", EXAMPLES[name])
        source = tmp_path / "uses.h"
        source.write_text(USES.format(name=Path(name).name, type=bsdf))
    run(
        [compiler, *flags, "-Werror", "-x", "c++", "-fsyntax-only", "-include", str(source), "/dev/null"],
        Path(like["directory"]),
    )


def test_examples_are_formatted(tmp_path: Path) -> None:
    files = []
    for name, text in EXAMPLES.items():
        files.append(tmp_path / Path(name).name)
        files[-1].write_text(text)
    style = f"--style=file:{ROOT / '.clang-format'}"
    tool = Path(sys.executable).parent / "clang-format"
    run([str(tool), style, "--dry-run", "-Werror", *map(str, files)], tmp_path)
