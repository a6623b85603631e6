"""Materials of glTF files."""

from __future__ import annotations

import base64
import binascii
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from ..errors import EtendueError
from .image import Kind, load_image
from .mtl import luminance
from .names import find_beside
from .types import Colour, Image, Material, Texture

_EXTENSIONS = {"image/png": ".png", "image/jpeg": ".jpg", "image/webp": ".webp", "image/ktx2": ".ktx2"}
_UNDERSTOOD = {"KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_texture_transform"}
_DEFAULT = "default"


class GltfMaterials:
    """The materials that a glTF file's meshes use, made on their first use.

    `view` gives the bytes of a buffer view. The type of a material comes from its name, as everywhere, so
    metalness and the like are told in a warning and left out.
    """

    def __init__(
        self, path: Path, header: dict[str, Any], view: Callable[[int], bytes], warnings: list[str]
    ) -> None:
        self.path, self.header, self.view, self.warnings = path, header, view, warnings
        self.found: list[Material] = []
        self._indices: dict[int | None, int] = {}
        self._names: set[str] = set()
        self._images: dict[tuple[int, Kind], Texture | None] = {}

    def index_of(self, number: int | None) -> int:
        """The index into `found` of the file's material `number`, or of the default one for None."""
        if number not in self._indices:
            self._indices[number] = len(self.found)
            try:
                self.found.append(Material(_DEFAULT) if number is None else self._material(number))
            except (KeyError, IndexError, TypeError, ValueError, OverflowError, AttributeError) as error:
                raise EtendueError(f"{self.path}: material {number} cannot be understood: {error}") from None
        return self._indices[number]

    def _material(self, number: int) -> Material:
        data: dict[str, Any] = self.header["materials"][number]
        pbr: dict[str, Any] = data.get("pbrMetallicRoughness", {})
        extensions: dict[str, Any] = data.get("extensions", {})
        material = Material(str(data.get("name") or f"material_{number}"))
        material.albedo = _colour(pbr.get("baseColorFactor", (1, 1, 1)))
        # The file's roughness is perceptual; its square is the GGX alpha.
        material.roughness = float(pbr.get("roughnessFactor", 1.0)) ** 2
        material.ior = float(extensions.get("KHR_materials_ior", {}).get("ior", 1.5))
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        red, green, blue = _colour(data.get("emissiveFactor", (0, 0, 0)))
        material.emission = (red * strength, green * strength, blue * strength)
        material.emissive_strength = luminance(material.emission)
        material.albedo_texture = self._texture(pbr.get("baseColorTexture"), "colour")
        material.emission_texture = self._texture(data.get("emissiveTexture"), "colour")
        material.normal_texture = self._texture(data.get("normalTexture"), "normal")
        if data.get("alphaMode", "OPAQUE") != "OPAQUE":
            material.cutout_texture = material.albedo_texture
        self._warn(material, pbr, extensions)
        return material

    def _warn(self, material: Material, pbr: dict[str, Any], extensions: dict[str, Any]) -> None:
        ignored = [name for name in extensions if name not in _UNDERSTOOD]
        if "KHR_texture_transform" in str(pbr):
            ignored.append("KHR_texture_transform")
        if pbr.get("metallicFactor", 0.0) >= 0.5 and "metal" not in material.name.lower():
            ignored.append('metallicFactor (the type "metal" in the scene file makes it a metal)')
        if "metallicRoughnessTexture" in pbr:
            ignored.append("metallicRoughnessTexture")
        if material.albedo_texture is not None and tuple(material.albedo) != (1, 1, 1):
            ignored.append("baseColorFactor (the texture replaces it)")
        if ignored:
            self.warnings.append(f'{self.path}: material "{material.name}": not used: {", ".join(ignored)}')

    def _texture(self, reference: dict[str, Any] | None, kind: Kind) -> Texture | None:
        if reference is None:
            return None
        source = self.header["textures"][reference["index"]].get("source")
        if source is None:
            self.warnings.append(
                f"{self.path}: texture {reference['index']} has no PNG or JPEG image; it is left out"
            )
            return None
        if (source, kind) not in self._images:
            self._images[source, kind] = self._image(source, kind)
        return self._images[source, kind]

    def _image(self, number: int, kind: Kind) -> Texture | None:
        data: dict[str, Any] = self.header["images"][number]
        uri = data.get("uri")
        if uri is not None and not uri.startswith("data:"):
            found = find_beside(self.path.parent, unquote(uri))
            if found is None:
                self.warnings.append(f"{self.path}: there is no texture {uri}; it is left out")
            return found
        label = f"{self.path}#image{number}"
        try:
            content = self.view(data["bufferView"]) if uri is None else base64.b64decode(uri.split(",", 1)[1])
            mime = data.get("mimeType") or (uri or "").partition(";")[0].removeprefix("data:")
            return _decoded(content, _EXTENSIONS.get(mime, ".png"), label, kind)
        except (EtendueError, binascii.Error) as error:
            self.warnings.append(f"{label}: the texture cannot be read and is left out: {error}")
            return None


def _decoded(content: bytes, extension: str, label: str, kind: Kind) -> Image:
    """Pixels of an image in memory; OpenImageIO reads files alone from Python."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, f"image{extension}")
        file.write_bytes(content)
        try:
            image = load_image(file, kind)
        except EtendueError as error:
            raise EtendueError(str(error).replace(str(file), label)) from None
    image.path = label
    return image


def _colour(values: Any) -> Colour:
    red, green, blue = (max(float(value), 0.0) for value in values[:3])
    return red, green, blue
