"""What progress says."""

from __future__ import annotations

import pytest

from etendue.cli.progress import Goal, shown


def test_never_complete_before_it_is() -> None:
    goal = Goal(32, 100)
    assert goal.describe(0.9999, 31.9968, 1.0)[0] == "99%"
    assert goal.describe(1.0, 32, 1.0)[0] == "100%"
    assert goal.describe(0.0, 0, 0.0)[0] == "0%"
    assert Goal(32, 100, time_limit=2.0).describe(0.5, 16, 2.5)[0] == "99%"


def test_words() -> None:
    goal = Goal(32, 1_000_000)
    assert goal.describe(0.25, 8, 10.0) == ("25%", "8/32 spp", "800 k samples/s", "30 s left")
    assert goal.describe(0.5, 16.04, 10.0)[1] == "16.0/32 spp"
    assert goal.describe(1.0, 32, 10.0) == ("100%", "32/32 spp", "3.2 M samples/s", "")
    assert goal.describe(0.0, 0.0, 0.0) == ("0%", "0/32 spp", "", "")


def test_a_time_limit_is_what_is_waited_for() -> None:
    goal = Goal(1000, 100, time_limit=10.0)
    assert goal.describe(0.01, 10, 5.0)[::3] == ("50%", "5.0 s left")
    assert goal.describe(0.9, 900, 5.0)[::3] == ("90%", "0.6 s left")
    assert goal.describe(1.0, 1000, 5.0)[::3] == ("100%", "")


def test_a_line_for_every_tenth_where_there_is_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with shown(Goal(10, 100), quiet=False) as report:
        for step in range(1001):
            report(step / 1000, step / 100)
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert [line.split()[0] for line in lines] == [f"{10 * tenth}%" for tenth in range(1, 11)]
    assert lines[4].startswith("50%  5/10 spp  ")
    assert captured.out == ""


def test_a_bar_in_a_terminal(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with shown(Goal(10, 100), quiet=False) as report:
        report(0.999, 9.99)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert " 99% 10.0/10 spp " in captured.err


def test_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    with shown(Goal(10, 100), quiet=True) as report:
        report(1.0, 10)
    assert capsys.readouterr() == ("", "")
