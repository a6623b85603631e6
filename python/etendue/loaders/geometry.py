"""Small geometry that several loaders share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from .types import Mesh

Floats = NDArray[np.float64]

#: coordinates beyond this are refused, as by the core, which squares areas in single precision
FARTHEST = 1e9


def normalised(vectors: NDArray[np.floating]) -> Floats:
    """Unit vectors, (n, 3); zero where the length is zero or not finite."""
    wide = np.asarray(vectors, np.float64)
    length = np.sqrt(np.einsum("ij,ij->i", wide, wide))
    usable = np.isfinite(length) & (length > 0)
    scale = np.divide(1.0, length, out=np.zeros_like(length), where=usable)
    return np.where(usable[:, None], wide, 0.0) * scale[:, None]


def face_normals(points: NDArray[np.floating], triangles: NDArray[np.integer]) -> Floats:
    """Unit normals of triangles, (m, 3); zero where a triangle has no area."""
    a, b, c = (np.asarray(points[triangles[:, corner]], np.float64) for corner in range(3))
    return normalised(np.cross(b - a, c - a))


def drop_degenerate(path: Path, meshes: list[Mesh], warnings: list[str]) -> list[Mesh]:
    """The meshes without triangles that have no area; a warning says how many were dropped.

    Raises EtendueError where nothing is left.
    """
    kept: list[Mesh] = []
    dropped = 0
    for mesh in meshes:
        # Exact zeros only: in double precision the cross product of float32 edges does not underflow.
        corners = mesh.vertices.astype(np.float64)[mesh.triangles]
        good = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).any(axis=1)
        if not good.all():
            dropped += int((~good).sum())
            mesh.triangles = mesh.triangles[good]
        if len(mesh.triangles):
            kept.append(mesh)
    if dropped:
        warnings.append(f"{path}: {dropped} triangle(s) without area dropped")
    if not kept:
        raise EtendueError(f"{path}: an empty mesh: every triangle has no area")
    return kept


def indexed_mesh(
    path: Path,
    name: str,
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    normals: NDArray[np.floating] | None = None,
    uvs: NDArray[np.floating] | None = None,
    material: int = 0,
) -> Mesh:
    """A mesh from arrays that another library read, checked: shapes, finite vertices, indices in range.

    Normals and texture coordinates that do not fit the vertices are left out. Raises EtendueError.
    """
    triangles = np.asarray(triangles).reshape(-1, 3)
    fits = np.asarray(np.abs(vertices) <= FARTHEST)
    bad = np.flatnonzero(~fits.all(axis=1))
    if len(bad):
        text = " ".join(f"{value:g}" for value in vertices[bad[0]])
        what = "is not finite" if not np.isfinite(vertices[bad[0]]).all() else "is too far away"
        raise EtendueError(f"{path}: vertex {bad[0]} {what}: {text}")
    wrong = np.flatnonzero(((triangles < 0) | (triangles >= len(vertices))).any(axis=1))
    if len(wrong):
        text = " ".join(map(str, triangles[wrong[0]]))
        raise EtendueError(f"{path}: triangle {wrong[0]} ({text}) refers beyond the {len(vertices)} vertices")
    mesh = Mesh(name, vertices.astype(np.float32), triangles.astype(np.uint32), material=material)
    if normals is not None and np.shape(normals) == np.shape(vertices):
        unit = normalised(normals)
        lacking = ~np.asarray(unit.any(axis=1))
        if lacking.any():
            flat = lacking[triangles].any(axis=1)
            unit[triangles[flat]] = face_normals(vertices, triangles[flat])[:, None]
        mesh.normals = unit.astype(np.float32)
    if uvs is not None and np.shape(uvs) == (len(vertices), 2):
        mesh.uvs = np.nan_to_num(np.asarray(uvs, np.float32), posinf=0, neginf=0)
    return mesh
