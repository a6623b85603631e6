"""Scenes loaded and rendered from Python, and files of the result."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import etendue
from etendue import EtendueError, Film, Scene, SceneError, _core
from etendue.config import Config
from etendue.config.patches import merged
from etendue.config.sections import MaterialPatch
from etendue.display import srgb_to_linear
from etendue.loaders.types import Material
from etendue.scene.materials import resolve

# A square of side 2 around the origin in the plane z = 0, facing +z, uv (0, 0) at its lower left.
SQUARE = "v -1 -1 {z}\nv 1 -1 {z}\nv 1 1 {z}\nv -1 1 {z}\n"
UVS = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ETENDUE_DATA", raising=False)


def square(name: str, material: str, mtl: str = "", z: float = 0, uvs: bool = True) -> None:
    corners = "f 1/1 2/2 3/3 4/4\n" if uvs else "f 1 2 3 4\n"
    text = f"mtllib {name}.mtl\n{SQUARE.format(z=z)}{UVS}usemtl {material}\n{corners}"
    Path(f"{name}.obj").write_text(text)
    Path(f"{name}.mtl").write_text(f"newmtl {material}\n{mtl}\n")


def config(meshes: list[str], **scene: Any) -> dict[str, Any]:
    """A camera one unit in front of the square, which just fills its image."""
    return {
        "framebuffer": {"res_w": 8, "res_h": 8, "sppx": 2},
        "camera": {"pos": [0, 0, 1], "dir": [0, 0, -1], "fov": 90},
        "filter": "box",
        "scene": {"mesh_files": [f"{name}.obj" for name in meshes], **scene},
    }


def lamp(**more: Any) -> Scene:
    square("lamp", "light", "Kd 1 0.5 0.25\nKe 3 3 3")
    return etendue.load(config(["lamp"], **more))


def image(name: str, pixels: np.ndarray) -> None:
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, oiio.UINT8 if pixels.dtype == np.uint8 else oiio.FLOAT)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    target = oiio.ImageOutput.create(name)
    assert target.open(name, spec)
    assert target.write_image(pixels)
    assert target.close()


def texts(scene: Scene) -> list[str]:
    return [str(warning) for warning in scene.warnings]


def refusal(source: Any, **more: Any) -> list[str]:
    with pytest.raises(SceneError) as caught:
        etendue.load(source, **more)
    return [str(problem) for problem in caught.value.problems]


class TestMaterials:
    def resolved(self, name: str, patch: dict[str, Any] | None = None, **own: Any) -> Any:
        made = None if patch is None else MaterialPatch(name=name, **patch)
        return resolve(Material(name, **own), made, _core.material_types())

    @pytest.mark.parametrize(
        ("name", "expected"),
        [
            ("ceilingLIGHT", "light"),
            ("my_emissive", "light"),
            ("floor_diffuse", "diffuse"),
            ("fabric_a.001", "diffuse"),
            ("staklo_crveno", "glass"),
            ("teapot_specular.001", "specular"),
            ("brushed metal", "metal"),
            ("goldfish", "gold"),
            ("Material.001", "default"),
            ("", "default"),
        ],
    )
    def test_type_by_name(self, name: str, expected: str) -> None:
        assert self.resolved(name).type == expected

    def test_type_of_the_patch_goes_before_the_name(self) -> None:
        assert self.resolved("glass", {"type": "gold"}).type == "gold"
        assert self.resolved("glass", {"ior": 1.2}).type == "glass"

    def test_defaults_of_the_type(self) -> None:
        gold = self.resolved("x", {"type": "gold"}, ior=1.5)
        assert gold.ior == pytest.approx(0.75)
        assert gold.absorb == pytest.approx(2.12)
        assert gold.albedo == pytest.approx((235 / 255, 197 / 255, 73 / 255))
        assert self.resolved("x", {"type": "diffuse"}, ior=1.7).ior == 1.7
        assert self.resolved("light").emissive_strength == 10
        assert self.resolved("light", emissive_strength=3.0).emissive_strength == 3

    def test_keys_of_the_patch_go_before_all(self) -> None:
        patch = {"type": "gold", "ior": 0.5, "roughness": 0.0, "absorb": 1.0, "albedo_col": (0.1, 0.2, 0.3)}
        gold = self.resolved("x", {**patch, "emissive_strength": 2.0, "coated": True})
        assert (gold.ior, gold.roughness, gold.absorb, gold.albedo) == (0.5, 0.0, 1.0, (0.1, 0.2, 0.3))
        assert (gold.emissive_strength, gold.coated) == (2, True)
        assert self.resolved("light", {"emissive_strength": 0.0}).emissive_strength == 0

    def test_of_two_patches_the_later_key_counts(self) -> None:
        first = MaterialPatch(name="a", ior=1.1, roughness=0.2)
        second = MaterialPatch(name="a", roughness=0.3)
        patch = merged([first, MaterialPatch(name="b"), second])["a"]
        assert (patch.ior, patch.roughness) == (1.1, 0.3)


class TestLoad:
    def test_a_lamp(self) -> None:
        scene = lamp()
        assert texts(scene) == []
        assert scene.core.triangle_count == 2
        assert [(light.kind, light.material) for light in scene.lights] == [("AreaLight", "light")]
        assert scene.load_seconds > 0
        assert scene.camera().width == 8
        assert scene.camera((20, 10)).width == 20

    def test_from_a_file_with_data_folders(self) -> None:
        square("lamp", "light")
        Path("data").mkdir()
        for suffix in ("obj", "mtl"):
            Path(f"lamp.{suffix}").rename(f"data/lamp.{suffix}")
        Path("scene.json").write_text(json.dumps(config(["lamp"])))
        assert etendue.load("scene.json", data_dirs=["data"]).core.triangle_count == 2
        assert len(refusal("scene.json")) == 1

    def test_auto_focus(self) -> None:
        square("lamp", "light")
        data = config(["lamp"])
        assert etendue.load(data).focal_depth == pytest.approx(1, rel=0.05)
        fixed = {**data, "auto_focus": False, "camera": {**data["camera"], "focal_depth": 3}}
        assert etendue.load(fixed).focal_depth == 3

    def test_all_missing_files_are_named_at_once(self) -> None:
        square("lamp", "light")
        data = config(["lmap", "nothing"], sky={"envmap": "gone.hdr"})
        Path("scene.json").write_text(json.dumps(data, indent=1))
        for source in ("scene.json", data):
            problems = refusal(source)
            assert len(problems) == 3
            assert "scene.mesh_files[0]: no such file" in problems[0]
            assert "scene.mesh_files[1]: no such file" in problems[1]
            assert "scene.sky.envmap: no such file" in problems[2]
        assert 'did you mean "lamp.obj"?' in refusal("scene.json")[0]
        assert refusal("scene.json")[0].startswith("scene.json:2")

    def test_all_broken_files_are_named_at_once(self) -> None:
        Path("a.obj").write_text("v 0 0 0\nf 1 2 3\n")
        Path("b.obj").write_text("v 0 nan 0\n")
        Path("c.hdr").write_text("no image")
        problems = refusal(config(["a", "b"], sky={"envmap": "c.hdr"}))
        assert problems[:2] == [
            "scene.mesh_files[0]: a.obj:2: a face refers to vertex 2, but the file has 1: f 1 2 3",
            "scene.mesh_files[1]: b.obj:1: a vertex that is not finite: v 0 nan 0",
        ]
        assert problems[2].startswith("scene.sky.envmap: c.hdr: not an image that can be read: ")

    def test_an_empty_scene(self) -> None:
        assert refusal(config([])) == ["scene: an empty scene: it names no mesh file and has no sky"]
        assert etendue.load(config([], sky={})).core.triangle_count == 0

    def test_without_light(self) -> None:
        square("wall", "wall")
        scene = etendue.load(config(["wall"]))
        (warning,) = texts(scene)
        assert warning.startswith("scene: no light: the image will be black; ")
        assert not scene.render().image.any()

    def test_warnings(self) -> None:
        square("lamp", "light", "Kd 2 1 1")
        square("wall", "white", "Kd 2 1 1")
        patches = [{"name": "lihgt", "ior": 1.2}]
        found: list[Any] = []
        data = config(["lamp", "wall"], materials=patches, volume_path="a.nvdb")
        scene = etendue.load(data, warnings=found)
        assert found == scene.warnings
        assert texts(scene) == [
            "scene.volume_path: volumes are not rendered; the scene is shown without it",
            'scene.materials[0].name: no mesh of the scene has a material of this name (got "lihgt"; '
            'did you mean "light"?)',
            'material "white": an albedo above 1 (2 1 1) reflects more light than arrives',
        ]

    def test_textures_that_cannot_be_used(self) -> None:
        Path("broken.png").write_text("no image")
        square("lamp", "light", "Kd 1 1 1\nKe 1 1 1\nmap_Ke broken.png")
        (warning,) = texts(etendue.load(config(["lamp"])))
        assert warning.startswith("broken.png: not an image that can be read: ")
        assert warning.endswith("; the texture is left out")
        image("good.png", np.full((2, 2, 3), 90, np.uint8))
        square("plain", "light", "Kd 1 1 1\nKe 1 1 1\nmap_Kd good.png", uvs=False)
        scene = etendue.load(config(["plain"]))
        assert texts(scene) == [
            'plain.obj: material "light" has textures, but its mesh has no texture coordinates; '
            "the plain colour is used"
        ]
        assert np.allclose(scene.render().image, 1)


class TestPixels:
    def test_emission(self) -> None:
        assert np.allclose(lamp().render().image, [3, 1.5, 0.75])

    def test_the_image_of_a_texture_is_upright(self) -> None:
        pixels = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [188, 188, 188]]], np.uint8)
        image("map.png", pixels.repeat(8, 0).repeat(8, 1))
        square("lamp", "light", "Ke 1 1 1\nmap_Ke map.png")
        seen = etendue.load(config(["lamp"])).render().image
        expected = srgb_to_linear(pixels / np.float32(255))
        assert np.allclose(seen[[2, 2, 5, 5], [2, 5, 2, 5]], expected.reshape(4, 3), atol=1e-3)

    @pytest.mark.parametrize("channels", [4, 1])
    def test_cut_out(self, channels: int) -> None:
        opacity = np.zeros((8, 8, channels), np.uint8)
        opacity[:4] = 255
        image("leaf.png", opacity)
        square("leaf", "leaf", f"Kd 0 0 0\n{'map_Kd' if channels == 4 else 'map_d'} leaf.png", z=0.5)
        square("lamp", "light", "Kd 1 1 1\nKe 2 2 2")
        scene = etendue.load(config(["lamp", "leaf"]))
        seen = scene.render(max_cam_path_length=1).image[:, :, 0]
        assert np.allclose(seen[:3], 0)
        assert np.allclose(seen[5:], 2)

    def test_sky(self) -> None:
        pixels = np.zeros((8, 16, 3), np.float32)
        pixels[:4] = (1, 2, 3)
        image("sky.exr", pixels)
        scene = etendue.load(config([], sky={"envmap": "sky.exr", "intensity": 2}))
        seen = scene.render().image
        assert np.allclose(seen[:3], (2, 4, 6), rtol=1e-3)
        assert np.allclose(seen[5:], 0)


class TestRender:
    def test_arguments(self) -> None:
        scene = lamp()
        calls: list[tuple[float, float]] = []
        film = scene.render(
            spp=3, size=(7, 5), algorithm="NaivePathtracer", progress=lambda *call: calls.append(call)
        )
        assert film.image.shape == (5, 7, 3)
        assert film.image.dtype == np.float32
        assert (film.sample_count == 3).all()
        assert (film.spp, film.samples) == (3, 105)
        assert film.complete
        assert not film.interrupted
        assert film.rays >= 105
        assert (film.invalid, film.invalid_count) == ([], 0)
        assert film.variance.shape == (5, 7, 3)
        assert np.allclose(film.variance, 0, atol=1e-5)
        assert all(0 <= fraction <= 1 and samples <= 3 for fraction, samples in calls)

    def test_threads_and_seeds(self) -> None:
        square("lamp", "light", "Kd 1 1 1\nKe 2 2 2", z=3)
        square("floor", "floor")
        scene = etendue.load(config(["lamp", "floor"], sky={}))
        first = scene.render(seed=3, threads=1).image
        assert (scene.render(seed=3, threads=2).image == first).all()
        assert (scene.render(seed=np.int64(4)).image != first).any()

    def test_parameters(self) -> None:
        scene = lamp()
        film = scene.render(mis="balance", rr_threshold=0.5, sampler="independent")
        assert json.loads(film.attributes["parameters"])["mis"] == "balance"
        assert film.attributes["sampler"] == "independent"

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (
                {"algorithm": "Pathtracr"},
                'render: algorithm: unknown algorithm (got "Pathtracr"; did you mean',
            ),
            ({"spp": 0}, "render: framebuffer.sppx: out of range (got 0; allowed: "),
            ({"size": (0, 5)}, "render: framebuffer.res_w: out of range (got 0; allowed: "),
            ({"mis": "pwer"}, 'render: mis: unknown value (got "pwer"; did you mean "power"?'),
            ({"miss": "power"}, 'render: miss: unknown key (did you mean "mis"?'),
            ({"camera": {}}, "render: camera cannot be changed for one render; load a changed scene instead"),
            ({"threads": -1}, "threads: 0 or a number of threads is needed, not -1"),
        ],
    )
    def test_wrong_arguments(self, arguments: dict[str, Any], message: str) -> None:
        with pytest.raises(EtendueError) as caught:
            lamp().render(**arguments)
        assert str(caught.value).startswith(message)

    def test_time_limit(self) -> None:
        film = lamp().render(spp=10**6, size=(64, 64), time_limit=0.2)
        assert not film.complete
        assert not film.interrupted
        assert 1 <= film.spp < 10**6

    def test_interrupt_keeps_what_is_done(self) -> None:
        def stop(fraction: float, samples: float) -> None:
            if samples >= 1:
                raise KeyboardInterrupt

        film = lamp().render(spp=10**6, size=(64, 64), progress=stop)
        assert film.interrupted
        assert not film.complete
        assert film.samples > 0

    def test_other_exceptions_are_raised(self) -> None:
        def fail(fraction: float, samples: float) -> None:
            raise RuntimeError("from progress")

        with pytest.raises(RuntimeError, match="from progress"):
            lamp().render(spp=10**6, size=(64, 64), progress=fail)


class TestFilm:
    def film(self) -> Film:
        return lamp().render()

    def read(self, name: str) -> tuple[np.ndarray, Any]:
        source = oiio.ImageInput.open(name)
        spec = source.spec()
        kind = oiio.UINT8 if str(spec.format) == "uint8" else oiio.FLOAT
        pixels = source.read_image(0, 0, 0, spec.nchannels, kind)
        source.close()
        return pixels, spec

    def test_exr(self) -> None:
        film = self.film()
        film.save("a.exr", attributes={"note": "grün", "rays": 2**40})
        pixels, spec = self.read("a.exr")
        assert (pixels == film.image).all()
        assert spec.get_string_attribute("etendue:algorithm") == "Pathtracer"
        assert spec.get_float_attribute("etendue:spp") == 2
        assert spec.get_string_attribute("etendue:note") == "grün"
        assert spec.get_string_attribute("etendue:rays") == str(2**40)
        assert (
            Config.from_data(json.loads(spec.get_string_attribute("etendue:config"))).framebuffer.res_w == 8
        )

    def test_hdr(self) -> None:
        self.film().save("a.hdr")
        assert np.allclose(self.read("a.hdr")[0], [3, 1.5, 0.75], rtol=0.01)

    @pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.JPEG"])
    def test_display(self, name: str) -> None:
        film = self.film()
        film.exposure = 0.5
        film.save(name)
        pixels = self.read(name)[0].astype(int)
        assert pixels.shape == (8, 8, 3)
        assert np.abs(pixels - [255, 225, 165]).max() <= (0 if name == "a.png" else 2)
        film.save(name, exposure=0)
        assert self.read(name)[0].max() == 0

    def test_unknown_kind(self) -> None:
        with pytest.raises(EtendueError) as caught:
            self.film().save("a.exe")
        hint = 'did you mean ".exr"? allowed: .exr, .hdr, .png, .jpg, .jpeg'
        assert str(caught.value) == f'a.exe: unknown kind of image ".exe" ({hint})'

    def test_unwritable(self) -> None:
        with pytest.raises(EtendueError, match=r"^no/a\.png: cannot be written: No such file or directory$"):
            self.film().save("no/a.png")

    @pytest.mark.parametrize("suffix", ["exr", "png", "hdr", "jpg"])
    def test_a_full_disk_leaves_the_old_file(self, suffix: str) -> None:
        name = f"a.{suffix}"
        Path(name).write_text("old")
        code = (
            "import resource, signal, numpy as np, etendue\n"
            "from etendue import film\n"
            "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
            "def store(path, data, store=film._store):\n"
            "    resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))\n"
            "    store(path, data)\n"
            "film._store = store\n"
            "noise = np.random.default_rng(0).random((300, 300, 3), np.float32)\n"
            "zero = np.zeros((300, 300, 3))\n"
            "try:\n"
            "    image = etendue.Film(noise, zero[:, :, 0].astype(np.uint64), zero, zero)\n"
            f"    image.save({name!r})\n"
            "except etendue.EtendueError as error:\n"
            "    print(error)\n"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout == f"{name}: cannot be written: File too large\n"
        assert Path(name).read_text() == "old"
        assert [path.name for path in Path().iterdir()] == [name]


def test_import_loads_nothing_heavy() -> None:
    heavy = {"numpy", "pydantic", "OpenImageIO", "etendue._core"}
    code = f"import sys, etendue; print(*sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
    for name in etendue.__all__:
        assert getattr(etendue, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        etendue.nothing  # noqa: B018
