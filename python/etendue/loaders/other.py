"""Mesh files without materials: PLY and STL, read by trimesh."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from .geometry import drop_degenerate, indexed_mesh
from .polygons import triangulate
from .types import Material, MeshFile

#: more than any header of a PLY file takes
_HEADER = 1 << 16


def load_plain(path: Path, warnings: list[str]) -> MeshFile:
    """Read a PLY or STL file; its one material is called like the file, without the extension."""
    kind = path.suffix[1:].upper()
    data = _read(path, kind)
    vertices, faces = data.get("vertices"), data.get("faces")
    if vertices is None or faces is None or not len(vertices) or not len(faces):
        raise EtendueError(f"{path}: no faces; a mesh needs vertices and faces")
    points, corners = _table(vertices, np.float64), _table(faces, np.int64)
    if points is None or corners is None or points.shape[1] != 3 or corners.shape[1] < 3:
        raise EtendueError(f"{path}: not a {kind} file that can be read: its vertices or faces are no table")
    if corners.shape[1] != 3:
        corners = _triangles(points, corners)
    normals = _table(data.get("vertex_normals"), np.float64)
    uvs = _table(getattr(data.get("visual"), "uv", None), np.float64)
    mesh = indexed_mesh(path, path.stem, points, corners, normals, uvs)
    return MeshFile(path, drop_degenerate(path, [mesh], warnings), [Material(path.stem)])


def _table(values: Any, kind: type[Any]) -> NDArray[Any] | None:
    """`values` as an array of rows; None where they are none, as the library gives from headers that lie."""
    try:
        table = np.asarray(values, kind)
    except (TypeError, ValueError, OverflowError):
        return None
    return table if table.ndim == 2 else None


def _triangles(vertices: NDArray[np.floating], faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles of polygons that all have as many corners as `faces` has columns."""
    if faces.min() < 0 or faces.max() >= len(vertices):
        # Left to the check that every mesh goes through, which tells the wrong one.
        return faces[:, :3]
    corners = faces.reshape(-1)
    slots, _ = triangulate(vertices.astype(np.float64), corners, np.arange(len(faces) + 1) * faces.shape[1])
    return corners[slots]


def _read(path: Path, kind: str) -> dict[str, Any]:
    from trimesh.exchange.ply import load_ply
    from trimesh.exchange.stl import load_stl

    try:
        with path.open("rb") as file:
            if kind == "STL":
                data: dict[str, Any] = load_stl(file)
                return data
            # Texture coordinates of faces split vertices, and the library leaves their normals behind.
            splits = b"texcoord" in file.read(_HEADER)
            file.seek(0)
            data = load_ply(file, fix_texture=splits, skip_materials=True)
            return {**data, "vertex_normals": None} if splits else data
    except OSError as error:
        raise EtendueError(f"{path}: cannot be read: {error.strerror or error}") from None
    except Exception as error:
        # The library reports a broken file by whichever exception it runs into.
        raise EtendueError(f"{path}: not a {kind} file that can be read: {error}") from error
