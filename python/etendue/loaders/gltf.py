"""glTF and GLB files: geometry by trimesh, materials from the file's own JSON.

trimesh rounds colours to 8 bits and knows no emissive strength, so it is given the file without materials but
for their numbers.
"""

from __future__ import annotations

import base64
import binascii
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from .geometry import drop_degenerate, face_normals, indexed_mesh
from .gltf_materials import GltfMaterials
from .types import Mesh, MeshFile

_GLB_MAGIC, _JSON_CHUNK, _BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942


def load_gltf(path: Path, warnings: list[str]) -> MeshFile:
    """Read the default scene of a glTF or GLB file, its nodes' transformations applied."""
    header, binary = _read(path)
    materials = GltfMaterials(path, header, lambda index: _view(path, header, binary, index), warnings)
    groups: dict[int, list[Mesh]] = {}
    for name, number, kwargs, transform in _pieces(path, header, binary):
        index = materials.index_of(number)
        mesh = _placed(path, name, kwargs, transform, index)
        groups.setdefault(index, []).append(mesh)
    if not groups:
        raise EtendueError(f"{path}: no triangles in the file's scene")
    meshes = [_merged(materials.found[index].name, group) for index, group in groups.items()]
    return MeshFile(path, drop_degenerate(path, meshes, warnings), materials.found)


def _read(path: Path) -> tuple[dict[str, Any], bytes | None]:
    """The JSON of the file, and the binary chunk of a GLB file."""
    try:
        data = path.read_bytes()
        binary = None
        if path.suffix.lower() == ".glb":
            data, binary = _chunks(data)
        header = json.loads(data)
        if not isinstance(header, dict) or not isinstance(header.get("asset"), dict):
            raise ValueError("it has no asset")
    except OSError as error:
        raise EtendueError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, struct.error, RecursionError) as error:
        raise EtendueError(f"{path}: not a glTF file that can be read: {error}") from None
    return header, binary


def _chunks(data: bytes) -> tuple[bytes, bytes | None]:
    magic, version, _ = struct.unpack_from("<III", data)
    if magic != _GLB_MAGIC or version != 2:
        raise ValueError("it is not GLB version 2")
    length, kind = struct.unpack_from("<II", data, 12)
    if kind != _JSON_CHUNK or len(data) < 20 + length:
        raise ValueError("its JSON is cut off")
    rest = 20 + length
    if len(data) < rest + 8:
        return data[20:rest], None
    size, kind = struct.unpack_from("<II", data, rest)
    if kind != _BINARY_CHUNK or len(data) < rest + 8 + size:
        raise ValueError("its binary data are cut off")
    return data[20:rest], data[rest + 8 : rest + 8 + size]


def _pieces(
    path: Path, header: dict[str, Any], binary: bytes | None
) -> list[tuple[str, int | None, dict[str, Any], NDArray[np.float64]]]:
    """(name, material number, trimesh's arguments, transformation) of each instance of a mesh's part."""
    from trimesh.exchange.gltf import load_glb
    from trimesh.exchange.gltf import load_gltf as load_json
    from trimesh.resolvers import FilePathResolver
    from trimesh.scene.transforms import SceneGraph

    bare = {key: value for key, value in header.items() if key not in ("textures", "images", "materials")}
    resolver = FilePathResolver(str(path.resolve()))
    try:
        bare["materials"] = [{"name": str(number)} for number in range(len(header.get("materials", [])))]
        text = json.dumps(bare).encode()
        if binary is None:
            data = load_json(io.BytesIO(text), resolver=resolver)
        else:
            data = load_glb(io.BytesIO(_glb(text, binary)), resolver=resolver)
        graph = SceneGraph(base_frame=data.get("base_frame", "world"))
        for edge in data["graph"]:
            graph.update(**edge)  # type: ignore[no-untyped-call]
        pieces = []
        for node in graph.nodes_geometry:
            transform, name = graph[node]
            kwargs = data["geometry"][name]
            if kwargs.get("faces") is not None and len(kwargs["faces"]):
                material = getattr(kwargs.get("visual"), "material", None)
                number = None if material is None or material.name is None else int(material.name)
                pieces.append((str(name), number, kwargs, np.asarray(transform, np.float64)))
        return pieces
    except Exception as error:
        # The library reports a broken file by whichever exception it runs into.
        what = f"{type(error).__name__}: {error}"
        raise EtendueError(f"{path}: not a glTF file that can be read: {what}") from error


def _glb(text: bytes, binary: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    head = struct.pack("<III", _GLB_MAGIC, 2, 28 + len(text) + len(binary))
    first = struct.pack("<II", len(text), _JSON_CHUNK)
    return head + first + text + struct.pack("<II", len(binary), _BINARY_CHUNK) + binary


def _view(path: Path, header: dict[str, Any], binary: bytes | None, index: int) -> bytes:
    """The bytes of a buffer view, of which images inside the file are made."""
    try:
        view = header["bufferViews"][index]
        uri = header["buffers"][view["buffer"]].get("uri")
        if uri is None:
            data = binary or b""
        elif uri.startswith("data:"):
            data = base64.b64decode(uri.split(",", 1)[1])
        else:
            data = (path.parent / uri).read_bytes()
        start = view.get("byteOffset", 0)
        return data[start : start + view["byteLength"]]
    except (OSError, KeyError, IndexError, TypeError, ValueError, binascii.Error) as error:
        raise EtendueError(f"{path}: the image in buffer view {index} cannot be read: {error}") from None


def _placed(
    path: Path, name: str, kwargs: dict[str, Any], transform: NDArray[np.float64], material: int
) -> Mesh:
    linear = transform[:3, :3]
    points, faces = np.asarray(kwargs["vertices"], np.float64), np.asarray(kwargs["faces"])
    if points.ndim != 2 or points.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        raise EtendueError(f"{path}: mesh {name}: its positions are no points, or its faces no triangles")
    local = points.shape
    points = points @ linear.T + transform[:3, 3]
    mirrored = np.linalg.det(linear) < 0
    normals = kwargs.get("vertex_normals")
    if normals is not None and np.shape(normals) == local:
        # The cofactor matrix is the inverse transpose but for its scale, and exists for flat objects too.
        cofactor = np.stack(
            [np.cross(linear[1], linear[2]), np.cross(linear[2], linear[0]), np.cross(*linear[:2])]
        )
        normals = np.asarray(normals, np.float64) @ cofactor.T * (-1 if mirrored else 1)
    else:
        normals = None
    uvs = getattr(kwargs.get("visual"), "uv", None)
    return indexed_mesh(path, name, points, faces[:, ::-1] if mirrored else faces, normals, uvs, material)


def _merged(name: str, meshes: list[Mesh]) -> Mesh:
    """One mesh of several with the same material; normals and uvs that some lack are filled in."""
    if any(mesh.normals is not None for mesh in meshes):
        meshes = [mesh if mesh.normals is not None else _flat(mesh) for mesh in meshes]
    normals = [mesh.normals for mesh in meshes if mesh.normals is not None]
    has_uvs = any(mesh.uvs is not None for mesh in meshes)
    uvs = [np.zeros((len(m.vertices), 2), np.float32) if m.uvs is None else m.uvs for m in meshes]
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    triangles = [mesh.triangles + np.uint32(start) for mesh, start in zip(meshes, starts, strict=True)]
    return Mesh(
        name,
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(triangles),
        np.concatenate(normals) if normals else None,
        np.concatenate(uvs) if has_uvs else None,
        meshes[0].material,
    )


def _flat(mesh: Mesh) -> Mesh:
    """The same mesh with normals that make it look flat; no vertex is shared any more."""
    corners = mesh.triangles.reshape(-1)
    normals = np.repeat(face_normals(mesh.vertices, mesh.triangles), 3, axis=0).astype(np.float32)
    triangles = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    uvs = None if mesh.uvs is None else mesh.uvs[corners]
    return Mesh(mesh.name, mesh.vertices[corners], triangles, normals, uvs, mesh.material)
