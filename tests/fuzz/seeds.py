"""Small valid files of every format, made by code: what mutations start from."""

from __future__ import annotations

import base64
import json
import struct
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

OBJ = b"""# two walls
mtllib m.mtl
o wall
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1e0 -.5
vt 0 0
vt 1 0
vt 1 1 0
vn 0 0 1
g left
usemtl red
s 1
f 1/1/1 2/2/1 3/3/1
usemtl light
f 1//1 2//1 \\
 3//1 4//1
f -4 -3 -2
f 1/1 2/2 3/3 4/1
"""
MTL = b"""newmtl red
Kd 0.8 0.1 0.1
Ks 0 0 0
Ke 0 0 0
Ns 100
Ni 1.5
d 0.5
illum 2
map_Kd -s 1 1 1 -o 0 0 image.png
map_d image.png
map_Bump -bm 0.3 image.png
newmtl light
Kd 1 1 1
Ke 5 5 5
map_Ke image.png
"""
PLY = b"""ply
format ascii 1.0
comment a square
element vertex 4
property float x
property float y
property float z
property float nx
property float ny
property float nz
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 0 0 1 255
1 0 0 0 0 1 255
1 1 0 0 0 1 0
0 1 0 0 0 1 0
3 0 1 2
3 0 2 3
"""
STL = b"""solid s
 facet normal 0 0 1
  outer loop
   vertex 0 0 0
   vertex 1 0 0
   vertex 1 1 0
  endloop
 endfacet
endsolid s
"""
POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4")
FACES = np.array([[0, 1, 2], [0, 2, 3]], "<u4")

CONFIG: dict[str, Any] = {
    "algorithm": "Pathtracer",
    "mis": "power",
    "max_cam_path_length": 4,
    "rr_threshold": 0.5,
    "seed": 3,
    "auto_focus": True,
    "framebuffer": {"res_w": 4, "res_h": 3, "sppx": 1, "exposure": 2.0},
    "camera": {"pos": [0, 0, 3], "dir": [0, 0, -1], "up": [0, 1, 0], "fov": 60, "lens_radius": 0.1},
    "scene": {
        "mesh_files": ["m.obj"],
        "materials": [{"name": "red", "type": "metal", "roughness": 0.3, "albedo_col": [0.5, 0.2, 0.1]}],
        "sky": {"envmap": "sky.hdr", "intensity": 2, "scene_radius": 3.0},
    },
}


def ply_binary() -> bytes:
    head = b"ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
    head += b"property float x\nproperty float y\nproperty float z\nelement face 2\n"
    head += b"property list uchar int vertex_indices\nend_header\n"
    return head + POINTS.tobytes() + b"".join(b"\3" + face.astype("<i4").tobytes() for face in FACES)


def stl_binary() -> bytes:
    triangles = (np.float32([0, 0, 1]).tobytes() + POINTS[face].tobytes() + b"\0\0" for face in FACES)
    return b"\0" * 80 + struct.pack("<I", len(FACES)) + b"".join(triangles)


def gltf(buffer_uri: bool = True) -> dict[str, Any]:
    """A textured square, with its buffer inside the JSON or beside it in a GLB's binary chunk."""
    uvs = POINTS[:, :2].astype("<f4")
    blobs = [POINTS.tobytes(), uvs.tobytes(), FACES.tobytes(), image("png")]
    data = b"".join(blobs)
    starts = np.cumsum([0, *map(len, blobs[:-1])]).tolist()
    buffer: dict[str, Any] = {"byteLength": len(data)}
    if buffer_uri:
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    views = [
        {"buffer": 0, "byteOffset": start, "byteLength": len(blob)}
        for start, blob in zip(starts, blobs, strict=True)
    ]
    accessors = [
        {
            "bufferView": 0,
            "componentType": 5126,
            "count": 4,
            "type": "VEC3",
            "min": [0, 0, 0],
            "max": [1, 1, 0],
        },
        {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5125, "count": 6, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": 4}
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [1, 2, 1], "children": [1]}, {"mesh": 0, "translation": [2, 0, 0]}],
        "meshes": [{"name": "square", "primitives": [primitive]}],
        "materials": [
            {
                "name": "paint",
                "pbrMetallicRoughness": {
                    "baseColorFactor": [1, 0.5, 0.2, 1],
                    "baseColorTexture": {"index": 0},
                },
                "emissiveFactor": [0, 0, 0.5],
                "alphaMode": "MASK",
                "extensions": {"KHR_materials_ior": {"ior": 1.4}},
            }
        ],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "buffers": [buffer],
        "bufferViews": views,
        "accessors": accessors,
    }


def glb() -> bytes:
    header = gltf(buffer_uri=False)
    inside = gltf()["buffers"][0]["uri"].split(",", 1)[1]
    binary = base64.b64decode(inside)
    return glb_of(header, binary + b"\0" * (-len(binary) % 4))


def glb_of(header: Any, binary: bytes) -> bytes:
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(binary))
    return (
        head
        + struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(binary), 0x004E4942)
        + binary
    )


@cache
def image(extension: str, compression: str = "") -> bytes:
    """A picture of 5 x 3 pixels in the format of this extension."""
    import OpenImageIO as oiio

    channels = 4 if extension == "png" else 3
    pixels = np.linspace(0, 1, 3 * 5 * channels, dtype=np.float32).reshape(3, 5, channels)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"image.{extension}")
        spec = oiio.ImageSpec(5, 3, channels, "half" if extension == "exr" else "uint8")
        spec.attribute("DateTime", "2000:01:01 00:00:00")
        if compression:
            spec.attribute("compression", compression)
        output = oiio.ImageOutput.create(str(path))
        assert output is not None
        output.open(str(path), spec)
        output.write_image(pixels)
        output.close()
        return path.read_bytes()


@cache
def corpus(target: str) -> list[bytes]:
    """The seeds of a target, see targets.py."""
    return {
        "scene": lambda: [json.dumps(CONFIG, indent=1).encode(), b'{"scene": {"sky": {}}}'],
        "obj": lambda: [OBJ, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"],
        "mtl": lambda: [MTL],
        "ply": lambda: [PLY, ply_binary()],
        "stl": lambda: [STL, stl_binary()],
        "gltf": lambda: [json.dumps(gltf()).encode()],
        "glb": lambda: [glb()],
        "png": lambda: [image("png")],
        "hdr": lambda: [image("hdr")],
        "exr": lambda: [image("exr", name) for name in ("none", "zip", "piz", "dwaa")],
        "jpg": lambda: [image("jpg")],
    }[target]()


WORDS: dict[str, list[bytes]] = {
    "scene": [b'"algorithm"', b'"sky"', b"null", b"1e999", b"-0", b"[[[[", b'"\\ud800"', b"NaN", b"9" * 30],
    "obj": [b"f ", b"v ", b"vn ", b"usemtl ", b"mtllib ", b"//", b"-1", b"\\\n", b"nan", b"1e39", b"9" * 20],
    "mtl": [b"newmtl ", b"map_Kd ", b"-o ", b"-mm ", b"Kd ", b"image.png", b"..", b"inf", b"-halo "],
    "ply": [b"element face ", b"property list ", b"property double ", b"uchar ", b"texcoord", b"99999999999"],
    "stl": [b"solid", b"facet normal", b"vertex ", b"endsolid", b"nan", b"\xff\xff\xff\xff"],
    "gltf": [
        b'"count":',
        b'"byteOffset":',
        b'"children":',
        b'"matrix":',
        b"-1",
        b"1e300",
        b"4294967295",
        b'"uri":',
    ],
    "glb": [b"JSON", b"BIN\0", b'"count":', b"\xff\xff\xff\x7f", b'"byteStride":', b'"sparse":'],
    "png": [b"IHDR", b"PLTE", b"iCCP", b"IDAT", b"tRNS", b"\x7f\xff\xff\xff", b"\0\0\xff\xff"],
    "hdr": [
        b"-Y 3 +X 5",
        b"+X 5 -Y 3",
        b"-Y 99999 +X 99999",
        b"FORMAT=32-bit_rle_xyze",
        b"EXPOSURE=",
        b"\2\2",
    ],
    "exr": [b"channels", b"dataWindow", b"compression", b"tiles", b"\xff\xff\xff\x7f", b"chlist", b"type"],
    "jpg": [b"\xff\xd8", b"\xff\xc0", b"\xff\xda", b"\xff\xe1", b"Exif\0", b"\xff\xff"],
}
