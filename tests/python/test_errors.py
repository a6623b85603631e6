"""How problems are told."""

from pathlib import Path

from etendue.errors import EtendueError, Problem, SceneError, nearest_name, show_value


def test_unknown_key_with_the_nearest_name() -> None:
    problem = Problem("unknown key", "scene.json", 12, "scene.sky.intensty", nearest="intensity")
    assert str(problem) == 'scene.json:12: scene.sky.intensty: unknown key (did you mean "intensity"?)'


def test_value_and_what_is_allowed() -> None:
    problem = Problem(
        "out of range", Path("a/b.json"), 3, "camera.fov", 180, "a number above 0 and below 180"
    )
    assert (
        str(problem)
        == "a/b.json:3: camera.fov: out of range (got 180; allowed: a number above 0 and below 180)"
    )


def test_all_hints_at_once() -> None:
    problem = Problem("unknown value", "--set", None, "mis", "powr", "power, balance, none", "power")
    assert str(problem) == (
        '--set: mis: unknown value (got "powr"; did you mean "power"? allowed: power, balance, none)'
    )


def test_bare_message() -> None:
    assert str(Problem("something is wrong")) == "something is wrong"


def test_null_is_a_value() -> None:
    assert str(Problem("wrong type", value=None)) == "wrong type (got null)"


def test_line_and_column_with_excerpt() -> None:
    problem = Problem("a comma is missing here", "s.json", 2, column=5, excerpt="    1 2\n     ^")
    assert str(problem) == "s.json:2:5: a comma is missing here\n    1 2\n     ^"


def test_scene_error_tells_all_problems() -> None:
    error = SceneError([Problem("first", "s.json", 1), "second"])
    assert str(error) == "s.json:1: first\nsecond"
    assert [problem.message for problem in error.problems] == ["first", "second"]
    assert isinstance(error, EtendueError)


def test_nearest_name() -> None:
    known = ["res_w", "res_h", "sppx", "exposure", "Pathtracer"]
    assert nearest_name("exposre", known) == "exposure"
    assert nearest_name("pathtracer", known) == "Pathtracer"
    assert nearest_name("xyz", known) is None
    assert nearest_name("spp", known) == "sppx"
    # A part of two names helps nobody.
    assert nearest_name("res", ["res_width", "res_height_pixels"]) is None
    assert nearest_name("anything", []) is None


def test_long_values_are_shortened() -> None:
    text = show_value(list(range(100)))
    assert len(text) == 60
    assert text.startswith("[0, 1, 2,")
    assert text.endswith(" ...")


def test_values_that_json_cannot_hold() -> None:
    assert show_value(Path("a")).endswith("Path('a')")
