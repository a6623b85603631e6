"""Mesh and image files: what is read from them, and what is said of broken ones."""

from __future__ import annotations

import base64
import json
import math
import time
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from etendue.errors import EtendueError
from etendue.loaders import MeshFile, load_image, load_mesh
from etendue.loaders.gltf import _glb
from etendue.loaders.polygons import triangulate
from etendue.loaders.types import Image

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def obj(text: str | bytes, mtl: str | bytes | None = None) -> tuple[MeshFile, list[str]]:
    Path("mesh.obj").write_bytes(text.encode() if isinstance(text, str) else text)
    if mtl is not None:
        Path("mesh.mtl").write_bytes(mtl.encode() if isinstance(mtl, str) else mtl)
    warnings: list[str] = []
    return load_mesh("mesh.obj", warnings), warnings


def refusal(name: str, content: str | bytes | None = None) -> str:
    if content is not None:
        Path(name).write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(EtendueError) as caught:
        load_mesh(name, [])
    return str(caught.value)


def png(name: str, pixels: np.ndarray) -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    height, width, channels = pixels.shape
    kind = {np.dtype("uint8"): oiio.UINT8, np.dtype("uint16"): oiio.UINT16}.get(pixels.dtype, oiio.FLOAT)
    spec = oiio.ImageSpec(width, height, channels, kind)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    target = oiio.ImageOutput.create(name)
    assert target.open(name, spec)
    assert target.write_image(pixels)
    assert target.close()


def grey(value: int = 128, channels: int = 3) -> np.ndarray:
    return np.full((2, 2, channels), value, np.uint8)


class TestObj:
    def test_a_triangle(self) -> None:
        file, warnings = obj(TRIANGLE + "f 1 2 3\n")
        (mesh,) = file.meshes
        assert mesh.vertices.dtype == np.float32
        assert mesh.triangles.dtype == np.uint32
        assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        assert mesh.triangles.tolist() == [[0, 1, 2]]
        assert mesh.normals is None
        assert mesh.uvs is None
        assert [material.name for material in file.materials] == ["default"]
        assert warnings == []

    @pytest.mark.parametrize(
        "text",
        [
            "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
            "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
            "\ufeffv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
            "  v 0 0 0\n\tv\t1 0 0\n v  0 1   0  \n\n f 1 2 3 \n",
            "v 0 0 0 # origin\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3 # all",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n  2 \\\n 3\n",
            "v .0 -0. 0e0\nv +1.0 0 0\nv 0 1.E+00 0\nf 1/ 2/ 3/\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n",
            "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
            "o a b\ng c\ns off\nv 0 0 0\nv 1 0 0\nv 0 1 0\np 1\nl 1 2\nvp 0 0\nf 1 2 3\n",
        ],
    )
    def test_ways_to_write_it(self, text: str) -> None:
        file, warnings = obj(text)
        (mesh,) = file.meshes
        assert mesh.vertices[mesh.triangles].tolist() == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
        assert warnings == []

    def test_negative_indices_count_back_from_their_line(self) -> None:
        more = "v 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"
        file, _ = obj(TRIANGLE + "f -3 -2 -1\n" + more)
        assert file.meshes[0].vertices[file.meshes[0].triangles][1, 0].tolist() == [5, 0, 0]

    def test_vertices_are_shared_by_what_they_agree_in(self) -> None:
        quad = TRIANGLE + "v 1 1 0\n"
        normals = "vn 0 0 2\nvn 0 1 0\n"
        same, _ = obj(quad + normals + "f 1//1 2//1 3//1\nf 2//1 4//1 3//1\n")
        assert same.meshes[0].vertices.shape == (4, 3)
        assert np.allclose(same.meshes[0].normals, [0, 0, 1])
        other, _ = obj(quad + normals + "f 1//1 2//1 3//1\nf 2//2 4//2 3//2\n")
        assert other.meshes[0].vertices.shape == (6, 3)

    def test_texture_coordinates_stay_as_they_are(self) -> None:
        file, _ = obj(TRIANGLE + "vt 0 0\nvt 1 0.25\nvt 0 1 0\nf 1/1 2/2 3/3\n")
        mesh = file.meshes[0]
        assert mesh.uvs is not None
        assert mesh.uvs[mesh.triangles].tolist() == [[[0, 0], [1, 0.25], [0, 1]]]

    def test_faces_that_lack_what_others_have(self) -> None:
        text = (
            TRIANGLE + "vt 0.5 0.5\nvn 1 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1 3 2\nf 1//1 2//1 3//1\nf 1/1 2/1 3/1\n"
        )
        file, _ = obj(text)
        mesh = file.meshes[0]
        assert mesh.normals is not None
        assert mesh.uvs is not None
        assert mesh.normals[mesh.triangles][:, 0].tolist() == [[1, 0, 0], [0, 0, -1], [1, 0, 0], [0, 0, 1]]
        assert mesh.uvs[mesh.triangles][:, 0].tolist() == [[0.5, 0.5], [0, 0], [0, 0], [0.5, 0.5]]

    def test_polygons(self) -> None:
        square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        file, _ = obj(square + "f 1 2 3 4\nf 1 2 3\n")
        assert len(file.meshes[0].triangles) == 3

    def test_one_mesh_for_each_material(self) -> None:
        faces = "usemtl a\nf 1 2 3\no x\nusemtl b\nf 1 2 3\ng y\nusemtl a\nf 3 2 1\nusemtl never\n"
        file, _ = obj("mtllib mesh.mtl\n" + TRIANGLE + faces, "newmtl b\nnewmtl a\nnewmtl never\n")
        assert [(mesh.name, len(mesh.triangles)) for mesh in file.meshes] == [("a", 2), ("b", 1)]
        assert [file.materials[mesh.material].name for mesh in file.meshes] == ["a", "b"]

    def test_triangles_without_area_are_dropped(self) -> None:
        file, warnings = obj(TRIANGLE + "f 1 2 3\nf 1 1 2\nf 1 2\n")
        assert len(file.meshes[0].triangles) == 1
        assert warnings == [
            "mesh.obj:6: 1 face(s) of fewer than three corners left out",
            "mesh.obj: 1 triangle(s) without area dropped",
        ]

    def test_tiny_triangles_are_kept(self) -> None:
        file, warnings = obj("v 0 0 0\nv 1e-12 0 0\nv 0 1e-12 0\nf 1 2 3\n")
        assert len(file.meshes[0].triangles) == 1
        assert warnings == []

    def test_unknown_statements_are_a_warning(self) -> None:
        _, warnings = obj(TRIANGLE + "f 1 2 3\nhello\nworld 3\n")
        assert warnings == ['mesh.obj:5: unknown statement "hello" (and 1 more such lines); ignored']

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            (TRIANGLE + "f 1 2 9\n", "mesh.obj:4: a face refers to vertex 9, but the file has 3: f 1 2 9"),
            (TRIANGLE + "f 0 1 2\n", "mesh.obj:4: a face refers to vertex 0, but the file has 3: f 0 1 2"),
            (TRIANGLE + "f -4 1 2", "mesh.obj:4: a face refers to vertex -4, but the file has 3: f -4 1 2"),
            ("f 1 2 3\n", "mesh.obj:1: a face refers to vertex 1, but the file has none: f 1 2 3"),
            (
                TRIANGLE + "vt 0 0\nf 1/1 2/2 3/1\n",
                "mesh.obj:5: a face refers to texture coordinate 2, but the file has 1: f 1/1 2/2 3/1",
            ),
            (
                TRIANGLE + "f 1//1 2//1 3//1\n",
                "mesh.obj:4: a face refers to normal 1, but the file has none: f 1//1 2//1 3//1",
            ),
            (
                TRIANGLE + "f 1 2 3\nf 1 x 3\n",
                "mesh.obj:5: a face whose corners are not v, v/vt, v//vn or v/vt/vn: f 1 x 3",
            ),
            (
                TRIANGLE + "f 1/1/1/1 2 3\n",
                "mesh.obj:4: a face whose corners are not v, v/vt, v//vn or v/vt/vn: f 1/1/1/1 2 3",
            ),
            ("v 0 0 0\nv 1 nan 0\n", "mesh.obj:2: a vertex that is not finite: v 1 nan 0"),
            ("v 0 0 0\nv 1 inf 0\n", "mesh.obj:2: a vertex that is not finite: v 1 inf 0"),
            ("v 0 0 0\nv 1e39 0 0\n", "mesh.obj:2: a vertex that is too far away: v 1e39 0 0"),
            ("\nv 0 0\n", "mesh.obj:2: a vertex needs 3 numbers: v 0 0"),
            ("v 0 0 0\nv 1 2 zwei\n", "mesh.obj:2: not a number: v 1 2 zwei"),
            ("v 1 \\\n 2 3\nv 1 2 zwei\n", "mesh.obj:3: not a number: v 1 2 zwei"),
            ("", "mesh.obj: no faces; an OBJ mesh needs vertices (v) and faces (f)"),
            (TRIANGLE, "mesh.obj: no faces; an OBJ mesh needs vertices (v) and faces (f)"),
            (TRIANGLE + "f 1 1 2\n", "mesh.obj: an empty mesh: every triangle has no area"),
            (
                "<html>\n<body>\n",
                'mesh.obj:1: not an OBJ file: unknown statement "<html>" (and 1 more such lines)',
            ),
        ],
    )
    def test_broken_files(self, text: str, message: str) -> None:
        assert refusal("mesh.obj", text) == message

    def test_any_bytes_are_refused(self) -> None:
        noise = np.random.default_rng(0)
        for _ in range(50):
            refusal("mesh.obj", noise.integers(0, 256, 300, np.uint8).tobytes())

    def test_any_damage_is_read_or_refused(self) -> None:
        good = (TRIANGLE + "vt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\nf -1//-1 1//1 2//1\n").encode()
        noise = np.random.default_rng(1)
        refusals: list[str] = []
        for _ in range(300):
            data = bytearray(good)
            data[noise.integers(len(data))] = noise.integers(256)
            Path("mesh.obj").write_bytes(data)
            try:
                mesh = load_mesh("mesh.obj", []).meshes[0]
            except EtendueError as error:
                refusals.append(str(error))
            else:
                assert mesh.triangles.max() < len(mesh.vertices)
        assert all(message.startswith("mesh.obj:") for message in refusals)

    def test_missing(self) -> None:
        assert refusal("nowhere.obj") == "nowhere.obj: no such file"

    def test_a_quarter_of_a_million_triangles_load_quickly(self) -> None:
        side = 354
        y, x = np.mgrid[0:side, 0:side].reshape(2, -1)
        first = (y * side + x + 1)[(x < side - 1) & (y < side - 1)]
        corners = np.stack(
            [first, first + side, first + 1, first + 1, first + side, first + side + 1], axis=1
        )
        with Path("mesh.obj").open("w") as file:
            file.writelines(f"v {a:.6f} {b:.6f} 0.5\n" for a, b in zip(x / side, y / side, strict=True))
            file.writelines(f"vt {a:.6f} {b:.6f}\n" for a, b in zip(x / side, y / side, strict=True))
            file.write("vn 0 0 1\n")
            for row in corners.tolist():
                file.write("f {}/{}/1 {}/{}/1 {}/{}/1\n".format(*(i for i in row[:3] for _ in (0, 1))))
                file.write("f {}/{}/1 {}/{}/1 {}/{}/1\n".format(*(i for i in row[3:] for _ in (0, 1))))
        start = time.process_time()
        (mesh,) = load_mesh("mesh.obj", []).meshes
        assert time.process_time() - start < 2.5
        assert len(mesh.triangles) == 2 * (side - 1) ** 2
        assert len(mesh.vertices) == side**2


class TestMtl:
    USE = "mtllib mesh.mtl\n" + TRIANGLE + "usemtl m\nf 1 2 3\n"

    def material(self, mtl: str | bytes, warnings: list[str] | None = None):
        file, found = obj(self.USE, mtl)
        if warnings is not None:
            warnings += found
        return file.materials[0]

    def test_numbers(self) -> None:
        material = self.material("newmtl m\nKd .1 .2 .3 # red\n\tKe 5 5 5\nNi 1.45\nNs 6\nillum 2\n")
        assert material.albedo == (0.1, 0.2, 0.3)
        assert material.emission == (5, 5, 5)
        assert material.emissive_strength == pytest.approx(5)
        assert material.ior == 1.45
        assert material.roughness == pytest.approx(math.sqrt(2 / 8))

    def test_luminance_of_emission(self) -> None:
        assert self.material("newmtl m\nKe 0 1 0\n").emissive_strength == pytest.approx(0.7152)

    @pytest.mark.parametrize(
        ("text", "albedo"),
        [
            ("Kd 0 0 0\nKs .3 .4 .5", (0.3, 0.4, 0.5)),
            ("Kd 0 0 0\nKs 0 0 0", (0, 0, 0)),
            ("Kd .1 .1 .1\nKs .3 .4 .5", (0.1, 0.1, 0.1)),
            ("Kd .5", (0.5, 0.5, 0.5)),
            ("", (0.8, 0.8, 0.8)),
        ],
    )
    def test_specular_where_diffuse_is_black(self, text: str, albedo: tuple[float, ...]) -> None:
        assert self.material(f"newmtl m\n{text}\n").albedo == albedo

    def test_textures(self) -> None:
        for name in ("k d.png", "dir/n.png", "b.png", "D.PNG", "e.png"):
            png(name, grey())
        text = (
            "newmtl m\r\nmap_Kd -s 2 2 2 -o 0 0 k d.png\r\nmap_Bump -bm 0.5 b.png\r\nnorm .\\dir\\n.png\r\n"
            'map_d -imfchan m d.png\r\nmap_Ke "e.png"\r\n'
        )
        warnings: list[str] = []
        material = self.material(text, warnings)
        assert material.albedo_texture == Path("k d.png")
        assert material.normal_texture == Path("dir/n.png")
        assert material.cutout_texture == Path("D.PNG")
        assert material.emission_texture == Path("e.png")
        assert warnings == []

    @pytest.mark.parametrize("key", ["map_Bump", "bump", "map_bump", "norm"])
    def test_names_of_normal_maps(self, key: str) -> None:
        png("b.png", grey())
        assert self.material(f"newmtl m\n{key} b.png\n").normal_texture == Path("b.png")

    def test_textures_of_another_machine(self) -> None:
        png("wood.png", grey())
        assert self.material("newmtl m\nmap_Kd C:\\Users\\me\\wood.png\n").albedo_texture == Path("wood.png")

    def test_what_is_missing_is_told(self) -> None:
        warnings: list[str] = []
        material = self.material("newmtl m\nmap_Kd gone.png\nKd x y z\nTr 0.5\n", warnings)
        assert material.albedo_texture is None
        assert warnings == [
            "mesh.mtl:3: cannot be understood, ignored: Kd x y z",
            'mesh.mtl: material "m": there is no texture gone.png; it is left out',
            'mesh.mtl: transparency (d, Tr) is not rendered; the type "glass" gives it to materials: "m"',
        ]

    def test_missing_file(self) -> None:
        file, warnings = obj(self.USE.replace("mesh.mtl", "gone.mtl"))
        assert file.materials[0].name == "m"
        assert warnings == ["mesh.obj:1: there is no material file gone.mtl; grey is used instead"]

    def test_unknown_material(self) -> None:
        file, warnings = obj(self.USE.replace("usemtl m", "usemtl metall"), "newmtl metal\n")
        assert file.materials[0].name == "metall"
        assert warnings == [
            'mesh.obj:5: unknown material "metall" (did you mean "metal"?); grey is used instead'
        ]

    def test_names_with_spaces_and_of_any_encoding(self) -> None:
        text = self.USE.replace("mesh.mtl", "my mesh.mtl").replace("usemtl m", "usemtl gr\u00fcnes Glas")
        Path("my mesh.mtl").write_bytes("newmtl gr\u00fcnes Glas\nKd 1 0 0\n".encode("latin-1"))
        file, warnings = obj(text.encode("latin-1"))
        assert (file.materials[0].name, file.materials[0].albedo) == ("gr\u00fcnes Glas", (1, 0, 0))
        assert warnings == []

    def test_several_files(self) -> None:
        Path("a.mtl").write_text("newmtl a\nKd 1 0 0\n")
        Path("b.mtl").write_text("newmtl m\nKd 0 1 0\n")
        file, warnings = obj(self.USE.replace("mesh.mtl", "a.mtl b.mtl"))
        assert file.materials[0].albedo == (0, 1, 0)
        assert warnings == []


class TestPolygons:
    def area(self, points: list[list[float]]) -> tuple[float, int, bool]:
        """Sum of the triangles' areas, their number, and whether all face +z."""
        corners = np.array(points, np.float64)
        slots, _ = triangulate(corners, np.arange(len(points)), np.array([0, len(points)]))
        a, b, c = corners[slots].transpose(1, 0, 2)
        doubled = np.cross(b - a, c - a)[:, 2]
        return float(np.abs(doubled).sum() / 2), len(slots), bool((doubled > 0).all())

    def test_convex(self) -> None:
        circle = [[math.cos(t), math.sin(t), 0.0] for t in np.linspace(0, 2 * math.pi, 9)[:-1]]
        area, count, front = self.area(circle)
        assert area == pytest.approx(4 * math.sin(math.pi / 4))
        assert (count, front) == (6, True)

    @pytest.mark.parametrize("start", range(5))
    def test_concave(self, start: int) -> None:
        points = [[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [2, 1, 0], [0, 4, 0]]
        area, count, front = self.area(points[start:] + points[:start])
        assert area == pytest.approx(10)
        assert (count, front) == (3, True)

    @pytest.mark.parametrize("start", range(4))
    def test_concave_quads(self, start: int) -> None:
        points = [[0.0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]]
        area, count, front = self.area(points[start:] + points[:start])
        assert area == pytest.approx(4)
        assert (count, front) == (2, True)

    def test_owners(self) -> None:
        points = np.random.default_rng(0).random((20, 3))
        slots, owners = triangulate(points, np.arange(14), np.array([0, 3, 7, 8, 10, 14]))
        assert owners.tolist() == [0, 1, 1, 4, 4]
        assert slots[0].tolist() == [0, 1, 2]

    def test_polygons_without_inside_do_not_hang(self) -> None:
        _, count, _ = self.area([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0]])
        assert count == 3


class TestPlain:
    HEADER = (
        "ply\nformat ascii 1.0\nelement vertex {n}\n{properties}element face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
    )

    def ply(self, names: str, rows: list[str], face: str) -> str:
        properties = "".join(f"property float {name}\n" for name in names.split())
        return self.HEADER.format(n=len(rows), properties=properties) + "\n".join([*rows, face, ""])

    def test_ply(self) -> None:
        rows = ["0 0 0 0 0 1 0 0", "1 0 0 0 0 1 1 0", "1 1 0 0 0 1 1 1", "0 1 0 0 0 1 0 1"]
        Path("quad.ply").write_text(self.ply("x y z nx ny nz s t", rows, "4 0 1 2 3"))
        file = load_mesh("quad.ply", [])
        (mesh,) = file.meshes
        assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert mesh.normals is not None
        assert mesh.normals.tolist() == [[0, 0, 1]] * 4
        assert mesh.uvs is not None
        assert mesh.uvs.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
        assert file.materials[0].name == "quad"

    def test_stl(self) -> None:
        facet = (
            "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        )
        Path("red_glass.stl").write_text(f"solid x\n{facet}endsolid x\n")
        file = load_mesh("red_glass.stl", [])
        mesh = file.meshes[0]
        assert mesh.vertices[mesh.triangles].tolist() == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
        assert file.materials[0].name == "red_glass"

    def test_broken(self) -> None:
        rows = ["0 0 0", "1 0 0", "1 nan 0"]
        assert (
            refusal("a.ply", self.ply("x y z", rows, "3 0 1 2")) == "a.ply: vertex 2 is not finite: 1 nan 0"
        )
        message = "a.ply: triangle 0 (0 1 7) refers beyond the 3 vertices"
        assert refusal("a.ply", self.ply("x y z", [*rows[:2], "0 1 0"], "3 0 1 7")) == message
        assert refusal("b.ply", "ply\nformat").startswith("b.ply: not a PLY file that can be read: ")
        for content in (b"", b"garbage" * 100, bytes(84)):
            assert refusal("c.stl", content).startswith("c.stl: ")
        assert (
            refusal("d.fbx") == 'd.fbx: unknown kind of mesh ".fbx" (allowed: .obj, .ply, .stl, .gltf, .glb)'
        )


class TestGltf:
    def header(self) -> tuple[dict, bytes]:
        png("pixel.png", np.arange(16, dtype=np.uint8).reshape(2, 2, 4) * 16)
        image = Path("pixel.png").read_bytes()
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4")
        uvs = np.array([[0, 0], [1, 0], [0, 1]], "<f4")
        indices = np.array([0, 1, 2], "<u2")
        binary = points.tobytes() + uvs.tobytes() + indices.tobytes() + b"\0\0"
        pbr = {"baseColorFactor": [0.02, 0.1, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.5}
        views = [(0, 36), (36, 24), (60, 6), (68, len(image))]
        accessors = [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 3,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [1, 1, 0],
            },
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ]
        header = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1]}],
            "meshes": [
                {
                    "primitives": [
                        {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 1},
                        {"attributes": {"POSITION": 0}, "indices": 2, "material": 0},
                        {"attributes": {"POSITION": 0}, "indices": 2},
                    ]
                }
            ],
            "materials": [
                {
                    "name": "light",
                    "emissiveFactor": [1, 1, 0.5],
                    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}},
                },
                {
                    "name": "leaf",
                    "pbrMetallicRoughness": {**pbr, "baseColorTexture": {"index": 0}},
                    "alphaMode": "MASK",
                },
            ],
            "textures": [{"source": 0}],
            "images": [{"bufferView": 3, "mimeType": "image/png"}],
            "accessors": accessors,
            "bufferViews": [{"buffer": 0, "byteOffset": a, "byteLength": n} for a, n in views],
            "buffers": [{"byteLength": 68 + len(image)}],
        }
        return header, binary + image

    def check(self, file: MeshFile, warnings: list[str]) -> None:
        by_name = {material.name: material for material in file.materials}
        assert set(by_name) == {"light", "leaf", "default"}
        assert by_name["light"].emission == (8, 8, 4)
        assert by_name["leaf"].albedo == (0.02, 0.1, 0.2)
        assert by_name["leaf"].roughness == 0.25
        texture = by_name["leaf"].albedo_texture
        assert isinstance(texture, Image)
        assert texture.pixels.reshape(-1).tolist() == list(range(0, 256, 16))
        assert by_name["leaf"].cutout_texture is texture
        meshes = {mesh.name: mesh for mesh in file.meshes}
        leaf = meshes["leaf"]
        placed = sorted(leaf.vertices[leaf.triangles].reshape(2, -1).tolist())
        # Mirrored, so it is wound the other way round to keep its front.
        assert placed == [[0, 1, 0, -1, 0, 0, 0, 0, 0], [5, 0, 0, 6, 0, 0, 5, 1, 0]]
        assert leaf.uvs is not None
        assert leaf.uvs.max() == 1
        name = str(file.path)
        message = f'{name}: material "leaf": not used: baseColorFactor (the texture replaces it)'
        assert warnings == [message]

    def test_glb(self) -> None:
        header, binary = self.header()
        Path("a.glb").write_bytes(_glb(json.dumps(header).encode(), binary))
        warnings: list[str] = []
        self.check(load_mesh("a.glb", warnings), warnings)

    @pytest.mark.parametrize("inline", [False, True])
    def test_gltf(self, inline: bool) -> None:
        header, binary = self.header()
        Path("a.bin").write_bytes(binary)
        data = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
        header["buffers"][0]["uri"] = data if inline else "a.bin"
        Path("a.gltf").write_text(json.dumps(header))
        warnings: list[str] = []
        self.check(load_mesh("a.gltf", warnings), warnings)

    def test_what_is_not_rendered_is_told(self) -> None:
        header, binary = self.header()
        header["materials"][0]["extensions"]["KHR_materials_transmission"] = {}
        header["materials"][0]["pbrMetallicRoughness"] = {"metallicFactor": 1}
        header["images"][0] = {"uri": "gone.png"}
        Path("a.glb").write_bytes(_glb(json.dumps(header).encode(), binary))
        warnings: list[str] = []
        load_mesh("a.glb", warnings)
        assert warnings == [
            "a.glb: there is no texture gone.png; it is left out",
            'a.glb: material "light": not used: KHR_materials_transmission, '
            'metallicFactor (the type "metal" in the scene file makes it a metal)',
        ]

    def test_broken(self) -> None:
        header, binary = self.header()
        whole = _glb(json.dumps(header).encode(), binary)
        prefix = "a.glb: not a glTF file that can be read: "
        assert refusal("a.glb", whole[:-100]) == prefix + "its binary data are cut off"
        assert refusal("a.glb", whole[:100]) == prefix + "its JSON is cut off"
        assert refusal("a.glb", b"glTFgarbage" * 10).startswith(prefix)
        assert refusal("b.gltf", "{").startswith("b.gltf: not a glTF file that can be read: ")
        assert (
            refusal("b.gltf", '{"asset": {"version": "2.0"}}') == "b.gltf: no triangles in the file's scene"
        )
        header["buffers"][0]["uri"] = "gone.bin"
        assert refusal("c.gltf", json.dumps(header)).startswith("c.gltf: not a glTF file that can be read: ")


class TestImages:
    def test_8_bit_stays_8_bit(self) -> None:
        pixels = np.random.default_rng(0).integers(0, 256, (3, 5, 4), np.uint8)
        png("a.png", pixels)
        image = load_image("a.png")
        assert image.srgb
        assert image.pixels.dtype == np.uint8
        assert (image.pixels == pixels).all()
        assert not load_image("a.png", "linear").srgb

    def test_16_bit_becomes_linear(self) -> None:
        png("a.png", np.full((1, 1, 3), 32768, np.uint16))
        image = load_image("a.png")
        assert not image.srgb
        assert image.pixels.dtype == np.float32
        assert image.pixels[0, 0, 0] == pytest.approx(0.21404, abs=1e-4)

    def test_float_stays_linear(self) -> None:
        pixels = np.random.default_rng(0).random((3, 5, 3), np.float32) * 1000
        png("a.exr", pixels)
        image = load_image("a.exr")
        assert (image.pixels == pixels).all()
        assert not image.srgb

    @pytest.mark.parametrize(("channels", "expected"), [(1, 1), (2, 4), (3, 3), (4, 4)])
    def test_channels(self, channels: int, expected: int) -> None:
        png("a.png", grey(channels=channels))
        assert load_image("a.png").pixels.shape == (2, 2, expected)

    def test_environment_from_8_bit(self) -> None:
        png("a.png", grey(188, 1))
        pixels = load_image("a.png", "environment").pixels
        assert pixels.shape == (2, 2, 3)
        assert pixels.dtype == np.float32
        assert pixels[0, 0, 0] == pytest.approx(0.5028865)

    def test_environment_is_finite_and_not_negative(self) -> None:
        png("a.exr", np.array([[[1, 2, 3], [np.inf, 1, 1], [np.nan, 1, 1], [-1, 1, 7]]], np.float32))
        warnings: list[str] = []
        pixels = load_image("a.exr", "environment", warnings).pixels
        assert pixels[0, :, 0].tolist() == [1, 7, 0, 0]
        assert len(warnings) == 1
        assert warnings[0].startswith("a.exr: 3 pixel(s) of the environment map are negative or not finite")

    def test_normal_maps_stay_and_height_maps_are_converted(self) -> None:
        normals = np.full((4, 4, 3), (128, 128, 255), np.uint8)
        normals[2, 3] = 160, 120, 230
        png("n.png", normals)
        assert (load_image("n.png", "normal").pixels == normals).all()
        # Grey but for what JPEG does to it, and not.
        for apart, stays in ((8, False), (9, True)):
            almost = np.full((4, 4, 3), 100, np.uint8)
            almost[1, 2, 1] += apart
            for name, pixels in (("8.png", almost), ("16.png", almost.astype(np.uint16) * 257)):
                png(name, pixels)
                assert (
                    np.allclose(load_image(name, "normal").pixels[0, 0], 100 if name[0] == "8" else 100 / 255)
                    == stays
                )
        ramp = np.tile(np.array([0, 40, 80, 120, 160, 200, 240, 255], np.uint8), (8, 1))
        png("h.png", ramp[..., None])
        flat = load_image("h.png", "normal").pixels[4, 3] / 127.5 - 1
        assert flat[0] < -0.2
        assert abs(flat[1]) < 0.01
        # Brighter at the top: higher where v is larger.
        png("v.png", np.ascontiguousarray(ramp.T[::-1])[..., None])
        tilted = load_image("v.png", "normal").pixels[4, 3] / 127.5 - 1
        assert tilted[1] < -0.2
        assert abs(tilted[0]) < 0.01

    def test_broken(self) -> None:
        png("a.png", np.random.default_rng(0).integers(0, 256, (64, 64, 3), np.uint8))
        Path("b.png").write_bytes(Path("a.png").read_bytes()[:2000])
        Path("c.png").write_text("no image")
        for name, message in (
            ("b.png", "b.png: the image is damaged: "),
            ("c.png", "c.png: not an image that can be read: "),
            ("d.png", "d.png: no such file"),
        ):
            with pytest.raises(EtendueError) as caught:
                load_image(name)
            assert str(caught.value).startswith(message)
