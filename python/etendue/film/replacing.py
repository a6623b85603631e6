"""Films on disk are replaced whole: written beside their place, then renamed.

What a process that was killed in between has left is removed by the next one that writes the same film. That
no living process is still at it shows from a lock, which ends with its process.
"""

from __future__ import annotations

import glob
import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import BinaryIO

# In large pieces, it is written fast.
_PIECE = 1 << 22


def replace(path: Path, content: BinaryIO) -> None:
    """Puts `content` at `path`; OSError where that fails, with the old file as it was."""
    # Of a link, what it points to is replaced.
    target = path.resolve()
    _sweep(target)
    temporary, file = _locked(target)
    try:
        with file:
            shutil.copyfileobj(content, file, _PIECE)
            file.flush()
            # A name on a file that is still on its way to the disk would not survive a power failure.
            os.fsync(file.fileno())
            temporary.chmod(_permissions())
            if sys.platform != "win32":
                temporary.replace(target)
        if sys.platform == "win32":
            temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _prefix(target: Path) -> str:
    return f".{target.stem[:100]}-"


def _locked(target: Path) -> tuple[Path, BinaryIO]:
    while True:
        handle, name = tempfile.mkstemp(prefix=_prefix(target), suffix=".part", dir=target.parent)
        _lock(handle)
        # Somebody may have swept it away before it was locked.
        if os.path.exists(name):
            return Path(name), os.fdopen(handle, "wb")
        os.close(handle)


def _sweep(target: Path) -> None:
    for left in target.parent.glob(f"{glob.escape(_prefix(target))}*.part"):
        try:
            handle = os.open(left, os.O_RDWR)
        except OSError:
            continue
        try:
            if _lock(handle):
                left.unlink(missing_ok=True)
        except OSError:
            continue
        finally:
            os.close(handle)


def _lock(handle: int) -> bool:
    """Whether nobody else has it."""
    try:
        import fcntl
    except ImportError:
        # Elsewhere no open file can be removed, which does as well.
        return True
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _permissions() -> int:
    # There is no way to ask for the mask without setting it.
    mask = os.umask(0o077)
    os.umask(mask)
    return 0o666 & ~mask
