"""The machine that this runs on, in words."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path


def processor() -> tuple[str, set[str]]:
    """Its name, and the names of what it can do as the system lists them."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return platform.processor() or platform.machine(), set()
    fields = dict(re.findall(r"^([^\t:]+?)\s*:\s*(.*)$", text, re.MULTILINE))
    flags = set((fields.get("flags") or fields.get("Features") or "").split())
    if platform.machine() in ("aarch64", "arm64"):
        flags.add("neon")
    return fields.get("model name", platform.machine()), flags


def threads() -> str:
    """How many threads may run at once."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    cores = os.cpu_count() or available
    text = str(available) if available == cores else f"{available} of {cores}"
    quota = _quota()
    return text if quota is None else f"{text}, limited to {quota:g} by the container"


def _quota() -> float | None:
    try:
        limit, period = Path("/sys/fs/cgroup/cpu.max").read_text(encoding="ascii").split()
        return None if limit == "max" else int(limit) / int(period)
    except (OSError, ValueError):
        return None
