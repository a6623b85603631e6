"""The textures of a scene: each image read once, whoever names it."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from ..loaders.image import Kind, load_image
from ..loaders.types import Image, Material, Texture

NONE = -1
# What the core cuts out: surfaces less opaque than this.
_CUTOUT = 0.1


class Textures:
    """Textures as the core wants them, by index; NONE stands for no texture.

    An image that cannot be read is a warning, and no texture.
    """

    def __init__(self, warnings: list[str]) -> None:
        self.images: list[Image] = []
        self._read: dict[tuple[Any, str], Future[Image]] = {}
        self._warnings = warnings
        self._indices: dict[tuple[Any, str], int] = {}

    def read_ahead(self, materials: Iterable[Material]) -> None:
        """Read the images of `materials` on all cores, as far as they are files."""
        wanted: dict[tuple[Any, Kind], Path] = {}
        for material in materials:
            for texture, kind in _files_of(material):
                if isinstance(texture, Path):
                    wanted[_key(texture), kind] = texture
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for (key, kind), path in wanted.items():
                self._read[key, kind] = pool.submit(load_image, path, kind)

    def colour(self, texture: Texture | None) -> int:
        """Index of an albedo or emission texture."""
        return self._index(texture, "colour")

    def normal(self, texture: Texture | None) -> int:
        """Index of a normal map, or of one made from a height map."""
        return self._index(texture, "normal")

    def cutout(self, texture: Texture | None, albedo: Texture | None) -> int:
        """Index of an opacity map: `texture`, or the alpha of `albedo`; NONE where nothing is cut out."""
        if texture is None or _key(texture) == _key(albedo):
            # The core takes alpha for the opacity where there is one.
            index = self.colour(albedo)
            return index if index != NONE and _is_transparent(self.images[index].pixels[..., 3:]) else NONE
        return self._index(texture, "linear")

    def _index(self, texture: Texture | None, kind: Kind) -> int:
        if texture is None:
            return NONE
        key = (_key(texture), kind)
        if key not in self._indices:
            try:
                image = texture if isinstance(texture, Image) else self._image(texture, kind)
            except EtendueError as error:
                self._warnings.append(f"{error}; the texture is left out")
                self._indices[key] = NONE
                return NONE
            image = _opacity(image) if kind == "linear" else image
            if kind == "linear" and not _is_transparent(image.pixels):
                self._indices[key] = NONE
            else:
                self._indices[key] = len(self.images)
                self.images.append(image)
        return self._indices[key]

    def _image(self, path: Path, kind: Kind) -> Image:
        read = self._read.get((_key(path), kind))
        return load_image(path, kind) if read is None else read.result()


def _files_of(material: Material) -> list[tuple[Texture | None, Kind]]:
    files: list[tuple[Texture | None, Kind]] = [
        (material.albedo_texture, "colour"),
        (material.emission_texture, "colour"),
        (material.normal_texture, "normal"),
    ]
    if _key(material.cutout_texture) != _key(material.albedo_texture):
        files.append((material.cutout_texture, "linear"))
    return files


def _key(texture: Texture | None) -> Any:
    return texture.resolve() if isinstance(texture, Path) else id(texture)


def _opacity(image: Image) -> Image:
    """One channel of an opacity map: alpha where it says anything, else the first."""
    pixels: NDArray[Any] = image.pixels
    channel = 3 if pixels.shape[2] == 4 and np.ptp(pixels[..., 3]) > 0 else 0
    return Image(np.ascontiguousarray(pixels[..., channel : channel + 1]), False, image.path)


def _is_transparent(opacity: NDArray[Any]) -> bool:
    whole = 255 if opacity.dtype == np.uint8 else 1
    return bool(opacity.min(initial=whole) < _CUTOUT * whole)
