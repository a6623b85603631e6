"""What is asked for early must be so in the machine code, as nothing else shows it but time."""

from __future__ import annotations

import platform
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(platform.machine() != "x86_64", reason="looks for x86's instruction")
def test_texels_are_prefetched() -> None:
    """GCC drops calls of functions that only prefetch, if it is let: src/gi/memory.h does not."""
    compiled = ROOT.glob("build/cp*/CMakeFiles/core.dir/src/gi/texture.cpp.o")
    newest = max(compiled, key=lambda file: file.stat().st_mtime)
    code = subprocess.run(
        ["objdump", "--disassemble", "--no-show-raw-insn", newest], check=True, capture_output=True, text=True
    ).stdout
    assert re.search(r"(?m)^\s+[0-9a-f]+:\s+prefetch", code)
