"""Images that cannot fit into memory, refused before the operating system ends the process for them."""

from __future__ import annotations

import os

from ..config import Config
from ..config.sections import Framebuffer
from ..errors import EtendueError
from ..words import si

# The renderer's sums, squares and counts in double precision, a copy of them in the film, and the image
# in single precision with what encoding it takes.
_BYTES_PER_PIXEL = 96 + 96 + 52


def of_image(framebuffer: Framebuffer) -> int:
    """Bytes that rendering and saving the image takes, the scene left aside."""
    return framebuffer.res_w * framebuffer.res_h * _BYTES_PER_PIXEL


def of_machine() -> int | None:
    """Bytes of memory that the machine has; None where it does not say."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None


def require(config: Config, beside: int = 0) -> None:
    """Raises EtendueError where the image, and `beside` bytes a pixel, need more memory than there is."""
    framebuffer = config.framebuffer
    needed = of_image(framebuffer) + framebuffer.res_w * framebuffer.res_h * beside
    there = of_machine()
    if there is not None and needed > there:
        size = f"{config.framebuffer.res_w} x {config.framebuffer.res_h}"
        raise EtendueError(
            f"an image of {size} pixels needs {si(needed)}B of memory; this machine has {si(there)}B"
        )
