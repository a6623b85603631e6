"""OBJ files with their materials."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError, nearest_name
from . import cache, obj_kept, obj_text
from .geometry import drop_degenerate, face_normals, normalised
from .mtl import load_mtl
from .names import find_beside
from .obj_kept import Parsed
from .obj_text import ObjText
from .polygons import triangulate
from .types import Material, Mesh, MeshFile

Ints = NDArray[np.int64]

#: the name of what is drawn before, or without, any usemtl
DEFAULT_MATERIAL = "default"
# Smaller files are read in a moment.
_LARGE = 1 << 20


def load_obj(path: Path, warnings: list[str]) -> MeshFile:
    """Read an OBJ file and its MTL files, as `load_mesh` says; from the cache where it is large and has not changed."""
    stamp = cache.stamp_of(path, _LARGE)
    parsed = None if stamp is None else obj_kept.find(path, stamp)
    if parsed is None:
        parsed = _parsed(path)
        if stamp is not None:
            obj_kept.keep(path, stamp, parsed)
    warnings += [f"{path}{note}" for note in parsed.notes]
    # What MTL files say is told anew each time: they are short, and name further files.
    return MeshFile(path, parsed.meshes, _materials(path, parsed, warnings), parsed.digest)


def _parsed(path: Path) -> Parsed:
    warnings: list[str] = []
    text = obj_text.read(path)
    if text.unknown is not None:
        line, word, count = text.unknown
        more = f" (and {count - 1} more such lines)" if count > 1 else ""
        if not len(text.corners.lines):
            raise EtendueError(f'{path}:{line}: not an OBJ file: unknown statement "{word}"{more}')
        warnings.append(f'{path}:{line}: unknown statement "{word}"{more}; ignored')
    corners, owner = triangulate(text.v, text.corners.indices[:, 0], text.corners.first)
    _count_left_out(path, text, warnings)
    if not len(corners):
        raise EtendueError(f"{path}: no faces; an OBJ mesh needs vertices (v) and faces (f)")
    table = text.corners.indices[corners]
    material_of, names = _material_of_faces(text)
    normals = _complete_normals(text, table)
    uvs = _complete_uvs(path, text, table, warnings)
    meshes = []
    of_triangle = material_of[owner]
    for index, name in enumerate(names):
        part = table if len(names) == 1 else table[of_triangle == index]
        if len(part):
            meshes.append(_mesh(name, index, text, normals, uvs, part))
    meshes = drop_degenerate(path, meshes, warnings)
    notes = [warning.removeprefix(str(path)) for warning in warnings]
    return Parsed(meshes, names, _first_uses(text), text.mtllib, notes)


def _count_left_out(path: Path, text: ObjText, warnings: list[str]) -> None:
    small = np.flatnonzero(np.diff(text.corners.first) < 3)
    if len(small):
        first = text.corners.lines[small[0]]
        warnings.append(f"{path}:{first}: {len(small)} face(s) of fewer than three corners left out")


def _material_of_faces(text: ObjText) -> tuple[Ints, list[str]]:
    """An index for each face into the names of the materials that are used, in order of their first use."""
    lines = np.array([line for line, _ in text.usemtl], np.int64)
    statements = [DEFAULT_MATERIAL] + [name or DEFAULT_MATERIAL for _, name in text.usemtl]
    statement = np.searchsorted(lines, text.corners.lines)
    used = dict.fromkeys(statements[index] for index in dict.fromkeys(statement.tolist()))
    index_of = {name: index for index, name in enumerate(used)}
    by_statement = np.array([index_of.get(name, 0) for name in statements], np.int64)
    return by_statement[statement], list(index_of)


def _materials(path: Path, parsed: Parsed, warnings: list[str]) -> list[Material]:
    known: dict[str, Material] = {}
    missing = False
    for line, argument in parsed.mtllib:
        # One name with spaces in it, or several names.
        whole = find_beside(path.parent, argument)
        for name in [argument] if whole else argument.split():
            found = find_beside(path.parent, name)
            if found is not None:
                known.update(load_mtl(found, warnings))
            else:
                missing = True
                warnings.append(f"{path}:{line}: there is no material file {name}; grey is used instead")
    for line, name in parsed.usemtl:
        if name in parsed.names and name not in known and not missing:
            near = nearest_name(name, known)
            hint = f' (did you mean "{near}"?)' if near else ""
            warnings.append(f'{path}:{line}: unknown material "{name}"{hint}; grey is used instead')
    return [known.get(name) or Material(name) for name in parsed.names]


def _first_uses(text: ObjText) -> list[tuple[int, str]]:
    first: dict[str, int] = {}
    for line, name in text.usemtl:
        first.setdefault(name, line)
    return [(line, name) for name, line in first.items()]


def _complete_normals(text: ObjText, table: Ints) -> NDArray[np.float32] | None:
    """Unit normals that column 2 of `table` refers to; triangles that lack one get that of their plane."""
    if not (table[..., 2] >= 0).any():
        return None
    normals = normalised(text.vn)
    usable = np.append(normals.any(axis=1), False)
    # Index -1 finds the False appended above.
    flat = np.flatnonzero(~usable[table[..., 2]].all(axis=1))
    if len(flat) == len(table):
        return None
    if len(flat):
        table[flat, :, 2] = len(normals) + np.arange(len(flat))[:, None]
        normals = np.concatenate([normals, face_normals(text.v, table[flat, :, 0])])
    return normals.astype(np.float32)


def _complete_uvs(path: Path, text: ObjText, table: Ints, warnings: list[str]) -> NDArray[np.float32] | None:
    """Texture coordinates that column 1 of `table` refers to; (0, 0) where there are none."""
    if not (table[..., 1] >= 0).any():
        return None
    bad = ~np.isfinite(text.vt).all(axis=1)
    if bad.any():
        warnings.append(f"{path}: {bad.sum()} texture coordinate(s) are not finite; 0 is used instead")
    uvs = np.concatenate([text.vt, np.zeros((1, 2))])
    uvs[np.append(bad, False)] = 0
    table[..., 1] = np.where(table[..., 1] < 0, len(text.vt), table[..., 1])
    return uvs.astype(np.float32)


def _mesh(
    name: str,
    material: int,
    text: ObjText,
    normals: NDArray[np.float32] | None,
    uvs: NDArray[np.float32] | None,
    table: Ints,
) -> Mesh:
    """A mesh with one vertex for each combination (v, vt, vn) of `table`, (m, 3 corners, 3)."""
    corners = table.reshape(-1, 3)
    key = corners[:, 0]
    for column, values in ((1, uvs), (2, normals)):
        if values is None:
            continue
        key, size = _densely_numbered(key)
        same = _determined_by(key, size, corners[:, column])
        key = key if same else key * len(values) + corners[:, column]
    key, size = _densely_numbered(key)
    chosen = np.zeros(size, np.int64)
    chosen[key] = np.arange(len(key))
    rows = corners[chosen]
    return Mesh(
        name,
        text.v[rows[:, 0]].astype(np.float32),
        key.reshape(-1, 3).astype(np.uint32),
        None if normals is None else normals[rows[:, 2]],
        None if uvs is None else uvs[rows[:, 1]],
        material,
    )


def _densely_numbered(keys: Ints) -> tuple[Ints, int]:
    """Keys renumbered from 0 in order of their size, and how many different ones there are."""
    top = int(keys.max()) + 1
    if top <= 8 * len(keys) + 1024:
        seen = np.zeros(top, bool)
        seen[keys] = True
        numbers = np.cumsum(seen) - 1
        return numbers[keys], int(numbers[-1]) + 1
    unique, inverse = np.unique(keys, return_inverse=True)
    return inverse.reshape(-1), len(unique)


def _determined_by(key: Ints, size: int, column: Ints) -> bool:
    """Whether corners of one key always agree in `column`, as where files write the same index thrice."""
    last = np.zeros(size, np.int64)
    last[key] = column
    return bool((last[key] == column).all())
