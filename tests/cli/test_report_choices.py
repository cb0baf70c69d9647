"""`adhoc report`: the order with intervals, and a part of the rows."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "evaluation"))
sys.path.insert(0, str(Path(__file__).parents[1] / "reporting"))

from test_report import RECORDS, failed

from adhoc.cli.main import main
from adhoc.evaluation.records import RecordFile


@pytest.fixture
def folder(tmp_path):
    others = {"team": "llm", "team_label": "LLM based"}
    more = [failed("a", **others, episode_id="x"), failed("a", "Random", 50, **others, episode_id="y")]
    for record in [*RECORDS, *more]:
        RecordFile(tmp_path / "run").append(record)
    return str(tmp_path / "run")


def test_the_order_comes_with_intervals_if_asked(folder, tmp_path, capsys):
    assert main(["report", folder]) == 0
    assert "By success" not in capsys.readouterr().out
    assert main(["report", folder, "--intervals", "--markdown", str(tmp_path / "table.md")]) == 0
    assert "By success, joining at step 50" in capsys.readouterr().out
    assert "## By success, joining at step 0" in (tmp_path / "table.md").read_text(encoding="utf-8")


def test_comparisons_and_power_come_last_if_asked(folder, tmp_path, capsys):
    page = tmp_path / "table.md"
    assert main(["report", folder, "--intervals", "--power", "--markdown", str(page)]) == 0
    told = capsys.readouterr().out
    assert (
        told.index("By success") < told.index("Who is told apart") < told.index("Tasks needed to tell apart")
    )
    text = page.read_text(encoding="utf-8")
    assert "## Who is told apart, joining at step 0" in text
    assert "## Tasks needed to tell apart, joining at step 50" in text
    assert main(["report", folder, "--power", "--difference", "20", "--family", "report"]) == 0
    told = capsys.readouterr().out
    assert "Who is told apart" not in told
    assert "20 points" in told


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        (["--difference", "5"], "--difference 5: goes with --power"),
        (["--power", "--difference", "0"], "0 points: a difference to be told is above 0"),
    ],
)
def test_a_difference_that_cannot_be_told_is_an_error(folder, capsys, options, fault):
    assert main(["report", folder, *options]) == 2
    told = capsys.readouterr()
    assert fault in told.err
    assert told.out == ""


def test_only_what_is_named_is_shown_beside_the_teams_alone(folder, capsys):
    assert main(["report", folder, "--team", "llm"]) == 0
    told = capsys.readouterr().out
    assert "LLM based" in told
    assert "Heuristic based" not in told
    assert main(["report", folder, "--team", "Heuristic based", "--team", "llm"]) == 0
    told = capsys.readouterr().out
    assert "Heuristic based" in told
    assert "LLM based" in told
    assert main(["report", folder, "--policy", "IRoT-LLM"]) == 0
    told = capsys.readouterr().out
    assert "IRoT-LLM" in told
    assert "No ad hoc" in told
    assert "Random" not in told


@pytest.mark.parametrize(
    ("option", "known"), [("--team", "'llm'"), ("--policy", "'IRoT-LLM', 'Random', 'none'")]
)
def test_a_name_that_is_not_there_is_an_error_that_tells_the_names(folder, capsys, option, known):
    assert main(["report", folder, option, "nobody"]) == 2
    told = capsys.readouterr().err
    assert f"{option} 'nobody': not in these folders" in told
    assert known in told
