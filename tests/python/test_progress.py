"""What progress says."""

from __future__ import annotations

import json

import pytest

from etendue.cli.progress import Goal, Status, shown


def test_never_complete_before_it_is() -> None:
    goal = Goal(32, 100)
    assert Status(goal, 0.9999, 31.9968, 1.0).words()[0] == "99%"
    assert Status(goal, 1.0, 32, 1.0).words()[0] == "100%"
    assert Status(goal, 0.0, 0, 0.0).words()[0] == "0%"
    assert Status(Goal(32, 100, time_limit=2.0), 0.5, 16, 2.5).words()[0] == "99%"


def test_words() -> None:
    goal = Goal(32, 1_000_000)
    words = ("25%", "8/32 spp", "800 k samples/s", "error 0.123", "30 s left")
    assert Status(goal, 0.25, 8, 10.0, 0.12345).words() == words
    assert Status(goal, 0.5, 16.04, 10.0).words()[1] == "16.0/32 spp"
    assert Status(goal, 1.0, 32, 10.0).words() == ("100%", "32/32 spp", "3.2 M samples/s", "", "")
    assert Status(goal, 0.0, 0.0, 0.0).words() == ("0%", "0/32 spp", "", "", "")


def test_a_beauty_render_is_on_its_way_to_the_bound() -> None:
    goal = Goal(None, 1_000_000, spp_before=10, bound=0.05)
    assert Status(goal, 0.0, 12, 1.0).words() == ("0%", "12 spp", "2 M samples/s", "", "")
    words = ("50%", "60 spp", "10 M samples/s", "error 0.0707 of 0.05", "6.0 s left")
    assert Status(goal, 0.5, 60, 5.0, 0.0707).words() == words
    in_time = Goal(None, 1_000_000, time_limit=8, spp_before=10, bound=0.05)
    assert Status(in_time, 0.5, 60, 5.0, 0.0707).words()[::4] == ("62%", "3.0 s left")
    assert Status(goal, 0.999, 110, 10.0, 0.05).words()[0] == "99%"


def test_a_time_limit_is_what_is_waited_for() -> None:
    goal = Goal(1000, 100, time_limit=10.0)
    assert Status(goal, 0.01, 10, 5.0).words()[::4] == ("50%", "5.0 s left")
    assert Status(goal, 0.9, 900, 5.0).words()[::4] == ("90%", "0.6 s left")
    assert Status(goal, 1.0, 1000, 5.0).words()[::4] == ("100%", "")


def test_a_line_for_every_tenth_where_there_is_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with shown(Goal(10, 100), quiet=False) as report:
        report.error(0.25)
        for step in range(1001):
            report(step / 1000, step / 100)
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert [line.split()[0] for line in lines] == [f"{10 * tenth}%" for tenth in range(1, 11)]
    assert lines[4].startswith("50%  5/10 spp  ")
    assert "samples/s  error 0.25  " in lines[4]
    assert captured.out == ""


def test_a_guess_that_was_wrong_takes_no_line_back(capsys: pytest.CaptureFixture[str]) -> None:
    with shown(Goal(None, 100, bound=0.1), quiet=False) as report:
        for fraction in (0.5, 0.3, 0.45, 0.65, 0.2, 1.0):
            report(fraction, 20)
    assert [line.split()[0] for line in capsys.readouterr().err.splitlines()] == ["50%", "65%", "100%"]


def test_objects_for_scripts(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    with shown(Goal(16, 100), quiet=True, as_json=True) as report:
        for step in range(17):
            clock[0] = 100 + step / 8
            report(step / 16, step)
            report.error(0.5)
        clock[0] += 0.01
        report(1.0, 16)
    captured = capsys.readouterr()
    found = [json.loads(line) for line in captured.err.splitlines()]
    assert captured.out == ""
    # Two a second, and always the end.
    assert [line["fraction"] for line in found] == [0, 0.25, 0.5, 0.75, 1, 1]
    assert found[0]["error"] is found[0]["seconds_left"] is found[0]["samples_per_second"] is None
    assert found[2] == {
        "event": "progress",
        "fraction": 0.5,
        "spp": 8,
        "spp_goal": 16,
        "samples_per_second": 800,
        "error": 0.5,
        "error_goal": None,
        "seconds": 1,
        "seconds_left": 1,
    }


def test_a_bar_in_a_terminal(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with shown(Goal(10, 100), quiet=False) as report:
        report.error(0.0312)
        report(0.999, 9.99)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert " 99% 10.0/10 spp " in captured.err
    assert "error 0.0312" in captured.err


def test_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    with shown(Goal(10, 100), quiet=True) as report:
        report(1.0, 10)
    assert capsys.readouterr() == ("", "")
