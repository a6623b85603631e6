"""Materials of OBJ files."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import EtendueError
from .names import find_beside
from .obj_lines import decode
from .types import Colour, Material

# How many values each option of a texture statement takes: at least, at most.
_OPTIONS = {
    "-blendu": (1, 1),
    "-blendv": (1, 1),
    "-bm": (1, 1),
    "-boost": (1, 1),
    "-cc": (1, 1),
    "-clamp": (1, 1),
    "-imfchan": (1, 1),
    "-mm": (2, 2),
    "-o": (1, 3),
    "-s": (1, 3),
    "-t": (1, 3),
    "-texres": (1, 1),
    "-type": (1, 1),
}
_MAPS = {"map_kd", "map_d", "map_ke", "map_bump", "bump", "norm", "map_norm"}
_NUMBERS = {"kd": 3, "ks": 3, "ke": 3, "ns": 1, "ni": 1, "d": 1, "tr": 1}


@dataclass
class _Statements:
    """What one `newmtl` block says: lower-case keyword -> numbers or file name."""

    name: str
    numbers: dict[str, list[float]] = field(default_factory=dict)
    maps: dict[str, str] = field(default_factory=dict)


def load_mtl(path: Path, warnings: list[str]) -> dict[str, Material]:
    """The materials of the MTL file `path`, by name.

    A statement that cannot be understood is a warning with its line; so is a texture that is not there.
    Raises EtendueError where the file cannot be read.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise EtendueError(f"{path}: cannot be read: {error.strerror or error}") from None
    materials: dict[str, Material] = {}
    transparent: list[str] = []
    for block in _blocks(path, data, warnings):
        if block.name in materials:
            warnings.append(f'{path}: the material "{block.name}" is given twice; the last one counts')
        materials[block.name] = _material(path, block, warnings)
        opacity = block.numbers.get("d", [1 - block.numbers.get("tr", [0.0])[0]])[0]
        if opacity < 1 and "map_d" not in block.maps:
            transparent.append(block.name)
    if transparent:
        names = ", ".join(f'"{name}"' for name in transparent)
        warnings.append(
            f'{path}: transparency (d, Tr) is not rendered; the type "glass" gives it to materials: {names}'
        )
    return materials


def _blocks(path: Path, data: bytes, warnings: list[str]) -> list[_Statements]:
    blocks: list[_Statements] = []
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    for number, raw in enumerate(text.split(b"\n"), 1):
        keyword, _, rest = decode(raw).strip().replace("\t", " ").partition(" ")
        key, rest = keyword.lower(), rest.strip()
        if key == "newmtl":
            blocks.append(_Statements(rest))
        elif key not in _MAPS and key not in _NUMBERS:
            continue
        elif not blocks:
            warnings.append(f"{path}:{number}: {keyword} before the first newmtl; ignored")
        elif key in _MAPS:
            blocks[-1].maps[key] = _file_name(rest)
        else:
            values = _numbers(rest, _NUMBERS[key])
            if values is None:
                warnings.append(f"{path}:{number}: cannot be understood, ignored: {keyword} {rest[:40]}")
            else:
                blocks[-1].numbers[key] = values
    return blocks


def _numbers(text: str, count: int) -> list[float] | None:
    words = text.split("#")[0].split()
    if words[:1] == ["-halo"]:
        words = words[1:]
    try:
        values = [float(word) for word in words[:count]]
    except ValueError:
        return None
    if count == 3 and len(values) == 1:
        values *= 3
    return values if len(values) == count and all(map(math.isfinite, values)) else None


def _file_name(text: str) -> str:
    """The file name of a texture statement, which comes after the options and may hold spaces."""
    rest = text.strip()
    while rest:
        word, _, after = rest.partition(" ")
        if word.lower() not in _OPTIONS:
            break
        least, most = _OPTIONS[word.lower()]
        rest = after.strip()
        for taken in range(most):
            word, _, after = rest.partition(" ")
            # Of the optional values only numbers belong to the option, and never the last word.
            if taken >= least and (not _is_number(word) or not after.strip()):
                break
            rest = after.strip()
    return rest


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _material(path: Path, block: _Statements, warnings: list[str]) -> Material:
    numbers = block.numbers

    def colour(key: str) -> Colour | None:
        values = numbers.get(key)
        return None if values is None else (max(values[0], 0.0), max(values[1], 0.0), max(values[2], 0.0))

    def texture(*keys: str) -> Path | None:
        for name in filter(None, (block.maps.get(key) for key in keys)):
            found = find_beside(path.parent, name)
            if found is not None:
                return found
            warnings.append(f'{path}: material "{block.name}": there is no texture {name}; it is left out')
        return None

    material = Material(block.name)
    diffuse, specular = colour("kd"), colour("ks")
    if diffuse is not None:
        material.albedo = diffuse
    if (diffuse is None or not any(diffuse)) and specular is not None and any(specular):
        material.albedo = specular
    material.emission = colour("ke") or material.emission
    material.emissive_strength = luminance(material.emission)
    # Exporters that know no index write 1, with which nothing would reflect.
    material.ior = numbers["ni"][0] if numbers.get("ni", [0.0])[0] > 1 else material.ior
    material.roughness = math.sqrt(2 / (max(numbers.get("ns", [0.0])[0], 0.0) + 2))
    material.albedo_texture = texture("map_kd")
    material.emission_texture = texture("map_ke")
    material.normal_texture = texture("norm", "map_norm", "map_bump", "bump")
    material.cutout_texture = texture("map_d")
    return material


def luminance(colour: Colour) -> float:
    """Luminance of linear sRGB."""
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
