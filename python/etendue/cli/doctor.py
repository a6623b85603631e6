"""What `etendue doctor` finds out: versions, processor, threads, and what is missing."""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Iterator
from importlib import metadata

from .. import machine
from ..errors import EtendueError

# Widest first; what Embree's kernels are compiled for.
_INSTRUCTION_SETS = (
    ("avx512f", "AVX-512"),
    ("avx2", "AVX2"),
    ("avx", "AVX"),
    ("sse4_2", "SSE4.2"),
    ("neon", "NEON"),
)
_REQUIREMENT = re.compile(r"\s*([A-Za-z0-9._-]+)\s*(?:\[[^\]]*\])?\s*\(?([^;)]*)\)?\s*(?:;(.*))?$")
_EXTRA = re.compile(r"extra\s*==\s*[\"']([^\"']+)[\"']")


def report() -> str:
    """Everything, in lines for people."""
    rows = [*_programs(), *_machine()]
    required, extras = _requirements()
    rows += [(name, installed(name) or "missing") for name in required]
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:<{width}}  {value}" for name, value in rows]
    return "\n".join([*lines, "", *_missing(required, extras)])


def _programs() -> Iterator[tuple[str, str]]:
    yield "etendue", installed("etendue") or "not installed as a package"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    try:
        from .. import _core
    except ImportError as error:
        yield "core", f"cannot be loaded: {error}"
        return
    yield "core", str(_core.__file__)
    for name, version in _core.versions():
        yield f"  {name}", version


def _machine() -> Iterator[tuple[str, str]]:
    yield "system", platform.platform()
    name, flags = machine.processor()
    yield "processor", name
    best = next((label for flag, label in _INSTRUCTION_SETS if flag in flags), "unknown")
    yield "  instruction set", best
    yield "threads", machine.threads()
    yield "file cache", _file_cache()


def _file_cache() -> str:
    try:
        from ..loaders import cache

        most = cache.limit() >> 20
    except (ImportError, EtendueError) as error:
        return str(error)
    kept = f"{cache.size() >> 20} of at most {most} MB in {cache.folder()}" if most else "off"
    return f"{kept} ({cache.VARIABLE})"


def _requirements() -> tuple[list[str], dict[str, list[str]]]:
    """The packages that Étendue needs, and those of each of its extras, as its own metadata says."""
    required: list[str] = []
    extras: dict[str, list[str]] = {}
    try:
        declared = metadata.requires("etendue") or []
    except metadata.PackageNotFoundError:
        declared = []
    for text in declared:
        match = _REQUIREMENT.match(text)
        if match is None:
            continue
        extra = _EXTRA.search(match.group(3) or "")
        target = required if extra is None else extras.setdefault(extra.group(1), [])
        target.append(match.group(1))
    return required, extras


def installed(name: str) -> str | None:
    """The version of a package; None where it is not installed."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _missing(required: list[str], extras: dict[str, list[str]]) -> Iterator[str]:
    python = sys.executable or "python3"
    for extra, names in (("", required), *extras.items()):
        absent = [name for name in names if installed(name) is None]
        label = f"{extra} (optional)" if extra else "required packages"
        if not absent:
            yield f"{label}: complete"
        else:
            wanted = f'"etendue[{extra}]"' if extra else " ".join(absent)
            yield f"{label}: without {', '.join(absent)}; install with: {python} -m pip install {wanted}"
