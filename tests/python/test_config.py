"""The scene file: what is read, and the whole text of what is told about one that is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from etendue import _core
from etendue.config import Config, json_schema, read_config
from etendue.config.overrides import Override
from etendue.config.schema import all_keys, describe, node_at, resolve
from etendue.errors import EtendueError, SceneError

ALGORITHMS = ", ".join(info.name for info in _core.algorithms())
MATERIAL_KEYS = "name, type, ior, roughness, absorb, albedo_col, emissive_strength, coated"
REPOSITORY = Path(__file__).parents[2]


@pytest.fixture
def problems(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Writes a text to s.json, reads it as a scene file and gives back the lines of the error."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ETENDUE_DATA", raising=False)

    def find(text: str, **options: Any) -> list[str]:
        Path("s.json").write_text(text, encoding="utf-8")
        with pytest.raises(SceneError) as caught:
            read_config("s.json", **options)
        return [str(problem) for problem in caught.value.problems]

    return find


def test_defaults_are_those_of_the_format() -> None:
    config = Config.from_data({})
    assert config.algorithm == "Pathtracer"
    assert (config.max_cam_path_length, config.max_light_path_length) == (10, 5)
    assert (config.rr_min_path_length, config.rr_threshold) == (1, 0.25)
    assert (config.auto_focus, config.beauty_render, config.error_eps) == (True, False, 0.05)
    assert (config.sampler, config.filter, config.seed) == ("sobol", "blackman_harris", 0)
    framebuffer = config.framebuffer
    assert (framebuffer.res_w, framebuffer.res_h, framebuffer.sppx) == (1280, 720, 10)
    assert (framebuffer.exposure, framebuffer.hdr) == (1, True)
    camera = config.camera
    assert (camera.pos, camera.dir, camera.up) == ((0, 0, 0), (0, 0, -1), (0, 1, 0))
    assert (camera.fov, camera.lens_radius, camera.focal_depth, camera.perspective) == (70, 0, 1, True)
    scene = config.scene
    assert (scene.mesh_files, scene.materials, scene.sky) == ([], [], None)
    assert (scene.volume_path, scene.volume) == (None, None)
    assert config.parameters()["mis"] == "power"


def test_everything_may_be_set() -> None:
    data = {
        "$schema": "scene.schema.json",
        "algorithm": "NaivePathtracer",
        "max_cam_path_length": 5.0,
        "mis": "balance",
        "seed": 7,
        "scene": {
            "mesh_files": ["a.obj"],
            "materials": [
                {
                    "name": "a.001",
                    "type": "glass",
                    "ior": 1.5,
                    "roughness": 0,
                    "absorb": 0.5,
                    "albedo_col": [1, 0.9, 0.8],
                    "emissive_strength": 3,
                    "coated": True,
                },
                {"name": "b", "ior": None},
            ],
            "sky": {"envmap": "sky.hdr", "intensity": 10, "scene_center": [0, 1, 0], "scene_radius": 4},
        },
    }
    config = Config.from_data(data)
    assert config.max_cam_path_length == 5
    assert config.scene.materials[0].albedo_col == (1, 0.9, 0.8)
    assert config.scene.materials[1].ior is None
    assert config.scene.sky is not None
    assert config.scene.sky.intensity == 10
    assert config.data == data
    assert config.warnings() == []


def test_all_problems_are_told_at_once(problems: Any) -> None:
    assert problems(
        """{
  "algorithm": "Pathtraser",
  "mis": "powr",
  "rr_threshold": -1,
  "max_cam_path_length": 2.5,
  "framebuffer": {"res_w": 0, "res_h": 70000, "exposure": "1", "hdr": 1},
  "camera": {
    "pos": [0, 0],
    "dir": [0, 0, 0],
    "up": [0, 1, "x"],
    "fov": 180
  },
  "scene": {
    "mesh_files": [3, ""],
    "materials": [
      {"name": "a", "roughnes": 1},
      {"roughness": 1.5, "albedo_col": [1, 2, 0]},
      7
    ],
    "sky": {
      "intensty": 3,
      "intensity": NaN,
      "scene_radius": 1e999
    }
  }
}
"""
    ) == [
        's.json:2: algorithm: unknown algorithm (got "Pathtraser"; did you mean "Pathtracer"? '
        f"allowed: {ALGORITHMS})",
        's.json:3: mis: unknown value (got "powr"; did you mean "power"? allowed: power, balance, none)',
        "s.json:4: rr_threshold: out of range (got -1; allowed: a number from 0 to 1000000)",
        "s.json:5: max_cam_path_length: wrong type (got 2.5; allowed: a whole number from 1 to 1000000)",
        "s.json:6: framebuffer.res_w: out of range (got 0; allowed: a whole number from 1 to 65536)",
        "s.json:6: framebuffer.res_h: out of range (got 70000; allowed: a whole number from 1 to 65536)",
        's.json:6: framebuffer.exposure: wrong type (got "1"; allowed: a number above 0)',
        "s.json:6: framebuffer.hdr: wrong type (got 1; allowed: true or false)",
        "s.json:8: camera.pos: three numbers are needed here, not 2 (got [0, 0])",
        "s.json:9: camera.dir: a direction cannot be zero (got [0, 0, 0])",
        's.json:10: camera.up[2]: wrong type (got "x"; allowed: a number)',
        "s.json:11: camera.fov: out of range (got 180; allowed: a number above 0 and below 180)",
        "s.json:14: scene.mesh_files[0]: wrong type (got 3; allowed: a text that is not empty)",
        's.json:14: scene.mesh_files[1]: empty (got ""; allowed: a text that is not empty)',
        's.json:16: scene.materials[0].roughnes: unknown key (did you mean "roughness"? '
        f"allowed: {MATERIAL_KEYS})",
        "s.json:17: scene.materials[1].name: this key is missing (allowed: a text that is not empty)",
        "s.json:17: scene.materials[1].roughness: out of range "
        "(got 1.5; allowed: a number from 0 to 1 or null)",
        "s.json:17: scene.materials[1].albedo_col[1]: out of range (got 2; allowed: a number from 0 to 1)",
        "s.json:18: scene.materials[2]: wrong type "
        f"(got 7; allowed: an object with the keys {MATERIAL_KEYS})",
        's.json:21: scene.sky.intensty: unknown key (did you mean "intensity"? '
        "allowed: envmap, intensity, scene_center, scene_radius)",
        "s.json:22: scene.sky.intensity: not a finite number (got NaN; allowed: a number of at least 0)",
        "s.json:23: scene.sky.scene_radius: not a finite number "
        "(got Infinity; allowed: a number above 0 or null)",
    ]


def test_numbers_that_single_precision_cannot_hold(problems: Any) -> None:
    assert problems('{"camera": {"dir": [1e39, 0, 1]},\n"framebuffer": {"exposure": 1e-300}}') == [
        "s.json:1: camera.dir[0]: too large for single precision (got 1e+39)",
        "s.json:2: framebuffer.exposure: too small for single precision (got 1e-300)",
    ]


@pytest.mark.parametrize("name", ["Bidirectional", "VolumetricPathtracer", "PhotonMapping", "LightCuts"])
def test_algorithms_of_later_sheets(problems: Any, name: str) -> None:
    assert problems(f'{{"algorithm": "{name}"}}') == [
        "s.json:1: algorithm: Étendue has no such algorithm; it belongs to a later exercise sheet "
        f'(got "{name}"; allowed: {ALGORITHMS})'
    ]


def test_a_key_of_another_section_is_recognised(problems: Any) -> None:
    (text,) = problems('{"fov": 70}')
    assert text.startswith('s.json:1: fov: unknown key (did you mean "camera.fov"? allowed: algorithm, ')


def test_a_key_given_twice(problems: Any) -> None:
    assert problems('{\n"seed": 1,\n"camera": {"fov": 60,\n"fov": 70},\n"seed": 2}') == [
        "s.json:4: camera.fov: this key is given twice, first on line 3",
        "s.json:5: seed: this key is given twice, first on line 2",
    ]


@pytest.mark.parametrize(("up", "direction"), [([0, 2, 0], [0, -3, 0]), ([1, 1, 0], [1, 1, 1e-9])])
def test_up_along_the_direction(problems: Any, up: list[float], direction: list[float]) -> None:
    text = json.dumps({"camera": {"dir": direction, "up": up}})
    assert problems(text) == [
        f"s.json:1: camera.up: parallel to dir, so nothing says what is up (got {json.dumps(up)})"
    ]


def test_the_default_up_can_be_along_the_direction(problems: Any) -> None:
    assert problems('{\n"camera": {"dir": [0, 1, 0]}}') == [
        "s.json:2: camera.up: parallel to dir, so nothing says what is up (got [0.0, 1.0, 0.0])"
    ]


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("framebuffer.sppx", 0),
        ("framebuffer.sppx", True),
        ("framebuffer.sppx", 2**31),
        ("framebuffer.exposure", 0),
        ("camera.fov", 0),
        ("camera.lens_radius", -0.1),
        ("camera.focal_depth", 0),
        ("camera.pos", [0, 0, float("inf")]),
        ("camera.pos", "0 0 0"),
        ("camera.pos", None),
        ("max_cam_path_length", 0),
        ("rr_min_path_length", -1),
        ("rr_threshold", "0.5"),
        ("error_eps", 0),
        ("seed", -1),
        ("seed", 2**32),
        ("sampler", "halton"),
        ("filter", 3),
        ("auto_focus", "yes"),
        ("framebuffer", []),
        ("scene", None),
        ("scene.mesh_files", "a.obj"),
        ("scene.sky", 1),
        ("scene.sky.intensity", -1),
        ("scene.sky.envmap", ""),
        ("scene.materials", {}),
        ("scene.materials[x].ior", 0),
        ("scene.materials[x].absorb", -1),
        ("scene.materials[x].emissive_strength", -1),
        ("scene.materials[x].coated", 0),
        ("scene.materials[x].name", 5),
    ],
)
def test_values_that_are_refused(key: str, value: Any) -> None:
    with pytest.raises(SceneError) as caught:
        Config.from_data({}).with_overrides([Override(key, value)])
    (problem,) = caught.value.problems
    assert problem.file == "--set"
    assert problem.path is not None
    assert problem.path.startswith(key.replace("[x]", "[0]"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"a": 1,}', '1:8: a comma before "}" is one too many\n    {"a": 1,}\n           ^'),
        ('{"a": 1 "b": 2}', '1:8: a comma is missing here\n    {"a": 1 "b": 2}\n           ^'),
        ("{a: 1}", "1:2: a key in double quotes is expected\n    {a: 1}\n     ^"),
        ('{"a" 1}', '1:6: expected ":" after the key "a"\n    {"a" 1}\n         ^'),
        ('{"a": }', '1:7: a value is expected before "}"\n    {"a": }\n          ^'),
        ('{"a": [1}', '1:9: expected "," or "]"\n    {"a": [1}\n            ^'),
        ('{\n  "a": {\n', '2:8: this "{" is never closed\n      "a": {\n           ^'),
        ('{"a": ', '1:7: the file ends where a value is expected\n    {"a": \n          ^'),
        ('{"a": "x', '1:7: the text that starts here has no closing quote\n    {"a": "x\n          ^'),
        (
            '{"a": "x\n"}',
            "1:9: a line break or control character inside a text: a closing quote is missing\n"
            '    {"a": "x\n            ^',
        ),
        (
            '{"a": "C:\\d"}',
            "1:10: a backslash in a text is written \\\\ (or use / in paths)\n"
            '    {"a": "C:\\d"}\n             ^',
        ),
        (
            "{\"a\": 'x'}",
            '1:7: texts stand in double quotes ("), not single ones\n    {"a": \'x\'}\n          ^',
        ),
        ('{"a": True}', '1:7: "True" is written true\n    {"a": True}\n          ^'),
        ('{"a": None}', '1:7: "None" is written null\n    {"a": None}\n          ^'),
        (
            '{"a": .5}',
            '1:7: ".5" is not a number as JSON writes it (0.5, -2, 1e-3)\n    {"a": .5}\n          ^',
        ),
        (
            '{"a": 01}',
            '1:7: "01" is not a number as JSON writes it (0.5, -2, 1e-3)\n    {"a": 01}\n          ^',
        ),
        ('{\n\t"a": 1, // b\n}', '2:10: JSON has no comments\n     "a": 1, // b\n             ^'),
        ('{"a": 1} 2', '1:10: something follows after the end of the scene\n    {"a": 1} 2\n             ^'),
        ("", "1:1: the file is empty, a scene is an object in { }"),
    ],
)
def test_syntax_errors_show_the_place(problems: Any, text: str, message: str) -> None:
    assert problems(text) == [f"s.json:{message}"]


def test_the_excerpt_of_a_long_line_is_short(problems: Any) -> None:
    (text,) = problems('{"a": [' + "1, " * 1000 + "x]}")
    head, line, caret = text.split("\n")
    assert head.startswith("s.json:1:3008: a value is expected")
    assert len(line) <= 104
    assert line[caret.index("^")] == "x"


def test_bottomless_nesting(problems: Any) -> None:
    (text,) = problems("[" * 100_000)
    assert text.startswith("s.json:1:66: nested more than 64 levels deep\n")


def test_something_else_than_an_object(problems: Any) -> None:
    (text,) = problems("[1]")
    assert text.startswith("s.json:1: wrong type (got [1]; allowed: an object with the keys ")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(EtendueError) as caught:
        read_config(tmp_path / "none.json")
    assert str(caught.value) == f"{tmp_path}/none.json: cannot be read: No such file or directory"
    with pytest.raises(EtendueError) as caught:
        read_config(tmp_path)
    assert str(caught.value) == f"{tmp_path}: cannot be read: Is a directory"
    (tmp_path / "latin.json").write_bytes(b'{"algorithm": "\xe9"}')
    with pytest.raises(EtendueError) as caught:
        read_config(tmp_path / "latin.json")
    assert str(caught.value) == f"{tmp_path}/latin.json: not a text file in UTF-8 (byte 15 cannot be read)"


def test_a_byte_order_mark_is_no_problem(tmp_path: Path) -> None:
    (tmp_path / "s.json").write_bytes(b'\xef\xbb\xbf{"seed": 3}\r\n')
    assert read_config(tmp_path / "s.json").seed == 3


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(json_values)
def test_any_json_is_read_as_the_standard_parser_reads_it(value: Any) -> None:
    from etendue.config.located_json import parse

    for text in (json.dumps(value, indent=1), json.dumps(value, ensure_ascii=False)):
        assert parse(text).value == json.loads(text)


@given(st.text(alphabet='{}[]",:.0123e-+ \n\\trufalsn'))
def test_anything_else_is_an_error_of_the_scene(text: str) -> None:
    from etendue.config.located_json import parse

    try:
        value = json.loads(text)
    except ValueError:
        with pytest.raises(SceneError):
            parse(text)
    else:
        assert parse(text).value == value


@given(json_values)
def test_no_data_breaks_the_check(value: Any) -> None:
    for data in (value, {"scene": value}, {"scene": {"materials": value, "sky": value}, "camera": value}):
        try:
            Config.from_data(data)
        except SceneError as error:
            assert error.problems  # noqa: PT017


def test_overrides_reach_every_key() -> None:
    config = Config.from_data(
        {"scene": {"materials": [{"name": "floor.001"}, {"name": "wall"}], "mesh_files": ["a"]}}
    )
    changed = config.with_overrides(
        [
            "rr_threshold=0.5",
            "mis=none",
            "camera.pos=[1, 2, 3]",
            "scene.sky.intensity=3",
            "scene.mesh_files.0=b=c.obj",
            "scene.materials.1.roughness=0.25",
            "scene.materials[0].type=glass",
            "scene.materials[floor.001].ior=2",
            'scene.materials["wall"].coated=true',
            "scene.materials[lamp].emissive_strength=4",
        ]
    )
    assert (changed.rr_threshold, changed.camera.pos) == (0.5, (1, 2, 3))
    assert changed.parameters()["mis"] == "none"
    assert changed.scene.sky is not None
    assert changed.scene.sky.intensity == 3
    assert changed.scene.mesh_files == ["b=c.obj"]
    floor, wall, lamp = changed.scene.materials
    assert (floor.type, floor.ior) == ("glass", 2)
    assert (wall.roughness, wall.coated) == (0.25, True)
    assert (lamp.name, lamp.emissive_strength) == ("lamp", 4)
    assert config.rr_threshold == 0.25
    assert config.scene.sky is None


@pytest.mark.parametrize(
    ("override", "message"),
    [
        (
            "scene.sky.intensty=3",
            '--set: scene.sky.intensty: unknown key (did you mean "intensity"? '
            "allowed: envmap, intensity, scene_center, scene_radius)",
        ),
        (
            "camera.fov=wide",
            '--set: camera.fov: wrong type (got "wide"; allowed: a number above 0 and below 180)',
        ),
        ("camera.fov.x=1", "--set: camera.fov: wrong type (allowed: a number above 0 and below 180)"),
        (
            "camera.dir=[0,1,0]",
            "--set: camera.up: parallel to dir, so nothing says what is up (got [0.0, 1.0, 0.0])",
        ),
        (
            "seed",
            "--set seed: a key, an equals sign and a value are needed, as in rr_threshold=0.5",
        ),
        ("=3", "--set =3: the key is missing before the equals sign"),
        ("seed.x=3", "--set seed.x=3: seed is a single value, with nothing inside it to set"),
        (
            "scene.materials.4.ior=1",
            "--set scene.materials.4.ior=1: scene.materials has no item 4 (allowed: 0 to 0)",
        ),
        (
            "scene.mesh_files.0=a",
            "--set scene.mesh_files.0=a: scene.mesh_files has no item 0 (allowed: none, the list is empty)",
        ),
        (
            "scene.materials.flor.ior=1",
            '--set scene.materials.flor.ior=1: no material "flor" is patched in scene.materials; '
            'did you mean "floor"?',
        ),
        ("scene[0]=1", "--set scene[0]=1: scene is no list; its keys are given with a dot"),
        (
            "a[=1",
            "--set a[=1: cannot read the key at '['; keys look like scene.materials[floor].roughness",
        ),
    ],
)
def test_overrides_that_are_refused(override: str, message: str) -> None:
    config = Config.from_data({"seed": 1, "scene": {"materials": [{"name": "floor"}], "mesh_files": []}})
    with pytest.raises(SceneError) as caught:
        config.with_overrides([override])
    assert str(caught.value) == message


def test_an_option_is_named_as_the_place() -> None:
    with pytest.raises(SceneError) as caught:
        Config.from_data({}).with_overrides([Override("framebuffer.sppx", 0, "--spp")])
    assert str(caught.value) == (
        "--spp: framebuffer.sppx: out of range (got 0; allowed: a whole number from 1 to 2147483647)"
    )


def test_problems_of_file_and_overrides_are_told_together(problems: Any) -> None:
    assert problems(
        '{"camera": {"fov": 0},\n"seed": -1}', overrides=["camera.fov=40", "rr_threshold=-1"]
    ) == [
        "--set: rr_threshold: out of range (got -1; allowed: a number from 0 to 1000000)",
        "s.json:2: seed: out of range (got -1; allowed: a whole number from 0 to 4294967295)",
    ]


def test_missing_files_are_told_with_the_rest(problems: Any, tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "castle.obj").touch()
    text = (
        '{"scene": {"mesh_files": [\n"castel.obj",\n"mis.obj"],\n'
        '"sky": {"envmap": "/nowhere/x.hdr"}},\n"seed": -1}'
    )
    looked = "under more, under $ETENDUE_DATA (which is not set), among the bundled scenes"
    assert problems(text, data_dirs=["more"]) == [
        f"s.json:2: scene.mesh_files[0]: no such file; looked as given, beside the scene file (.), {looked} "
        '(got "castel.obj"; did you mean "castle.obj"?)',
        f's.json:4: scene.sky.envmap: no such file; looked as given, {looked} (got "/nowhere/x.hdr")',
        "s.json:5: seed: out of range (got -1; allowed: a whole number from 0 to 4294967295)",
    ]


def test_files_are_found_in_the_order_of_the_format(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folders = [tmp_path / name for name in ("cwd", "config", "data", "environment")]
    for folder in folders:
        (folder / "sub").mkdir(parents=True)
        (folder / "sub" / "a.obj").touch()
    cwd, beside, data, environment = folders
    (beside / "s.json").write_text('{"scene": {"mesh_files": ["sub/a.obj"]}}')
    monkeypatch.chdir(cwd)
    monkeypatch.setenv("ETENDUE_DATA", str(environment))
    config = read_config(beside / "s.json")
    for expected in (Path(), beside, data, environment):
        found = config.find_file("sub/a.obj", [data])
        assert found == expected / "sub/a.obj"
        found.unlink()
    with pytest.raises(SceneError) as caught:
        config.find_file("sub/a.obj", [data])
    assert str(caught.value) == (
        f"{beside}/s.json:1: scene.mesh_files[0]: no such file; looked as given, "
        f"beside the scene file ({beside}), "
        f'under {data}, under {environment}, among the bundled scenes (got "sub/a.obj")'
    )


def test_warnings(tmp_path: Path) -> None:
    (tmp_path / "s.json").write_text(
        """{"beauty_render": true,
"scene": {"volume_path": "fog.nvdb", "volume": {"density": 1}, "materials": [
{"name": "a", "type": "glas"},
{"name": "b", "type": "my_fabric_7"},
{"name": "a", "ior": 1.5}]}}"""
    )
    warnings = [
        str(warning).removeprefix(f"{tmp_path}/") for warning in read_config(tmp_path / "s.json").warnings()
    ]
    assert len(warnings) == 4
    assert warnings[:2] == [
        "s.json:2: scene.volume_path: volumes are not rendered; the scene is shown without it",
        "s.json:2: scene.volume: volumes are not rendered; the scene is shown without it",
    ]
    assert warnings[2].startswith(
        's.json:3: scene.materials[0].type: contains no known type, so the material is "default" '
        '(got "glas"; did you mean "glass"? allowed: '
    )
    assert warnings[3] == (
        "s.json:5: scene.materials[2].name: an earlier patch has the same name; "
        'where both set a key, this one counts (got "a")'
    )


def test_a_config_cannot_be_changed_behind_the_checks() -> None:
    with pytest.raises(ValueError, match="frozen"):
        Config.from_data({}).seed = 3  # type: ignore[misc]


def test_schema_is_closed_and_says_everything_about_every_key() -> None:
    schema = json_schema()
    assert schema["title"] == "Étendue scene"
    objects = [schema, *schema["$defs"].values()]
    assert all(node["additionalProperties"] is False for node in objects if "properties" in node)
    for path, node in all_keys(schema):
        assert node.get("title") or "$ref" in node, path
        assert node.get("description") or "$ref" in node or "$ref" in str(node.get("anyOf")), path
        assert "default" in node or path.endswith(".name"), path
        assert describe(schema, node), path
    fov = node_at(schema, ("camera", "fov"))
    assert fov is not None
    assert (fov["exclusiveMinimum"], fov["exclusiveMaximum"], fov["default"]) == (0, 180, 70)
    assert schema["properties"]["mis"]["enum"] == ["power", "balance", "none"]
    assert schema["properties"]["algorithm"]["enum"] == ALGORITHMS.split(", ")
    json.dumps(schema)


def test_the_page_on_the_format_has_a_row_for_every_key() -> None:
    page = (REPOSITORY / "docs" / "scene-format.md").read_text(encoding="utf-8")
    schema = json_schema()
    fixed = {field.alias or name for name, field in Config.model_fields.items()}
    for path, node in all_keys(schema):
        inner = resolve(schema, node)
        if "properties" in inner or "$ref" in inner.get("items", {}):
            continue
        if "." not in path and path not in fixed:
            # A registered algorithm's own parameter: `etendue algorithms` tells of those.
            continue
        allowed = (
            "one of those that `etendue algorithms` lists" if path == "algorithm" else describe(schema, node)
        )
        default = f"`{_plain(node['default'])}`" if "default" in node else "none, it is needed"
        row = f"| `{path}` | {default} | {allowed} | {node['description']} |"
        assert row in page, f"docs/scene-format.md lacks this row:\n{row}"


def test_the_page_on_the_format_is_right_about_types_of_material() -> None:
    page = (REPOSITORY / "docs" / "scene-format.md").read_text(encoding="utf-8")
    table = page[page.index("| type | the text contains |") :].splitlines()[2:]
    rows = [[cell.strip(" `") for cell in row.split("|")[1:-1]] for row in table[: table.index("")]]
    known = {kind.name: kind for kind in _core.material_types()}
    assert [row[0] for row in rows] == [name for name in known if name in {row[0] for row in rows}]
    for row in rows:
        kind = known[row[0]]
        assert row[1] == (", ".join(kind.matches) or "anything else")
        for key in ("ior", "absorb", "roughness"):
            value = getattr(kind, key)
            said = key if value is None else f"{key} {value:.3g}"
            assert (said in row[3]) == (value is not None), row


def test_common_keys_are_what_the_algorithms_declare() -> None:
    root = json_schema()["properties"]
    for parameter in (parameter for info in _core.algorithms() for parameter in info.parameters):
        node = root[parameter.name]
        assert node["default"] == parameter.default
        if parameter.kind in ("int", "float"):
            assert (node["minimum"], node["maximum"]) == (parameter.minimum, parameter.maximum)


def _plain(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_plain, value))}]"
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)


@pytest.mark.parametrize("path", sorted((REPOSITORY / "configs").glob("*.json")), ids=lambda path: path.stem)
def test_the_bundled_configs_are_without_fault(path: Path) -> None:
    assert read_config(path).warnings() == []
