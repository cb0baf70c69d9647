"""`adhoc report`: its files, figures, the paper's numbers, and records that are not as they should be."""

from __future__ import annotations

import errno
import json
import os
import re
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "evaluation"))
sys.path.insert(0, str(Path(__file__).parents[1] / "reporting"))

from latex_structure import check_latex
from test_report import RECORDS, episode, failed

from adhoc.cli.main import main
from adhoc.evaluation.records import UNFINISHED_NAME, RecordFile
from adhoc.experiments.failures import Failure, FailureFile


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "run"
    RecordFile(path).replace(RECORDS)
    return path


def report(folder, *options):
    return main(["report", str(folder), *map(str, options)])


def test_all_files_say_the_same(folder, tmp_path, capsys):
    files = {it: tmp_path / f"report.{it}" for it in ("markdown", "latex", "html")}
    options = [part for it, path in files.items() for part in (f"--{it}", path)]
    assert report(folder, *options, "--intervals", "--paper") == 0
    shown = capsys.readouterr().out
    texts = {it: path.read_text(encoding="utf-8") for it, path in files.items()}
    for text in (shown, *texts.values()):
        for told in (
            "language model: tiny",
            "joins at step 50",
            "100.0 (100.0)",
            "contradict each other",
            "37.5",
        ):
            assert told in text
    assert len(check_latex(texts["latex"])) >= 4
    assert texts["html"].startswith("<!doctype html>")


def test_every_table_names_the_model_of_its_records(tmp_path, capsys):
    counts = {"made": 3, "judged": 3, "right": 1, "named": 2}
    predictions = {"predictions": {"within": 20, "sub_tasks": counts, "sub_skills": counts}}
    llm = {"llm": {"calls": 3, "cost_usd": 1.0, "stages": {}}}
    told = [{**it, **(predictions | llm if it["model"] else {})} for it in RECORDS]
    RecordFile(tmp_path / "run").replace(told)
    files = {it: tmp_path / f"report.{it}" for it in ("markdown", "latex", "html")}
    options = [part for it, path in files.items() for part in (f"--{it}", path)]
    assert report(tmp_path / "run", *options, "--intervals", "--power", "--paper") == 0
    titles = {
        "markdown": r"^## (.*)$",
        "latex": r"^\\caption\{(.*)\}$",
        "html": r"^<h2>(.*)</h2>$",
    }
    kinds = (
        "joins at",
        "Predictions",
        "What a success",
        "Calls",
        "By success",
        "Who is told",
        "Tasks needed",
    )
    for name, pattern in titles.items():
        found = re.findall(pattern, files[name].read_text(encoding="utf-8"), re.MULTILINE)
        assert all(any(kind in it for it in found) for kind in kinds)
        assert [it for it in found if "language model: tiny" not in it] == [
            it for it in found if "contradict" in it and "language model: gpt-4-1106-preview" in it
        ]
    shown = " ".join(capsys.readouterr().out.split())
    for kind in kinds[1:]:
        assert "language model: tiny" in shown[shown.index(kind) :][:100]


def test_labels_get_the_prefix_that_is_asked_for(folder, tmp_path, capsys):
    path = tmp_path / "tables.tex"
    assert report(folder, "--latex", path, "--label-prefix", "small") == 0
    labels = re.findall(r"label\{(.*?)\}", path.read_text(encoding="utf-8"))
    assert len(labels) > 1
    assert all(it.startswith("tab:small-") for it in labels)
    assert report(folder, "--label-prefix", "small") == 2
    assert "--label-prefix small: goes with --latex" in capsys.readouterr().err


def test_figures_are_drawn_and_put_into_the_page(folder, tmp_path, capsys):
    page = tmp_path / "report.html"
    assert report(folder, "--figures", tmp_path / "figures", "--html", page) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "2 figures, as SVG and PNG, in" in told
    assert "4 episodes recorded by a version that did not tell the ad hoc robot's ability" in told
    assert page.read_text(encoding="utf-8").count("<svg ") == 2
    assert len(list((tmp_path / "figures").glob("*.png"))) == 2
    assert "[" not in page.read_text(encoding="utf-8").split("Figures")[0].split("<tbody>")[1], (
        "no intervals asked"
    )


@pytest.mark.parametrize("option", ["--markdown", "--latex", "--html", "--figures"])
def test_a_full_disk_leaves_the_old_files(folder, tmp_path, option, monkeypatch, capsys):
    out = tmp_path / ("figures" if option == "--figures" else "report")
    assert report(folder, option, out) == 0
    before = {it: it.read_bytes() for it in tmp_path.rglob("*") if it.is_file()}
    again = [episode("c"), episode("c", "Random", 50, "tiny")]
    RecordFile(folder).replace([*RECORDS, *again])
    before[folder / "episodes.jsonl"] = (folder / "episodes.jsonl").read_bytes()

    def full(file):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("adhoc.core.whole_file.os.fsync", full)
    capsys.readouterr()
    assert report(folder, option, out) == 2
    told = capsys.readouterr().err
    assert str(out) in told
    assert "cannot be written: No space left on device" in told
    assert {it: it.read_bytes() for it in tmp_path.rglob("*") if it.is_file()} == before


@pytest.mark.parametrize("option", ["--markdown", "--latex", "--html"])
@pytest.mark.parametrize("name", ["episodes.jsonl", "provenance/0.json", "run.lock"])
def test_nothing_is_written_over_a_run(folder, option, name, capsys):
    assert report(folder, option, folder / name) == 2
    assert f"{option} {folder / name}: a run keeps its" in capsys.readouterr().err


def test_the_papers_numbers_need_no_records(tmp_path, capsys):
    page = tmp_path / "paper.md"
    assert main(["report", "--paper", "--markdown", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "language model: gpt-4-1106-preview" in capsys.readouterr().out
    assert "| LLM based | **IRoT-LLM** |" not in text
    assert "| LLM based | IRoT-LLM | **26.3 (24.6)** | **35.1 (29.0)** |" in text
    assert "| Table 2, Heuristic based, t0=50, No ad hoc | #TS | 367.3 (-) | 7 of the 7 percentages" in text


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ([], "DIR: name a run folder, or ask for the paper's numbers with --paper"),
        (["--paper", "--figures", "x"], "--figures: needs a run folder"),
        (["--paper", "--intervals"], "--intervals: needs a run folder"),
        (["--paper", "--html", "nowhere/x.html"], "--html nowhere/x.html: there is no such folder"),
    ],
)
def test_options_that_do_not_fit_are_one_line(options, fault, capsys):
    assert main(["report", *options]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"adhoc report: error: {fault}")
    assert told.count("\n") == 1


@pytest.mark.filterwarnings("always")
def test_a_torn_record_is_warned_of_and_told_in_the_files(folder, tmp_path, capsys):
    path = folder / "episodes.jsonl"
    path.write_bytes(path.read_bytes()[:-20])
    page = tmp_path / "report.md"
    assert report(folder, "--markdown", page) == 0
    assert "episodes.jsonl, line 6: incomplete last record left out" in capsys.readouterr().err
    assert "line 6: incomplete last record left out" in page.read_text(encoding="utf-8")


def test_a_flipped_byte_is_an_error_and_nothing_is_written(folder, tmp_path, capsys):
    path = folder / "episodes.jsonl"
    path.write_bytes(path.read_bytes().replace(b'"temporal_steps":250', b'"temporal_steps":240'))
    assert report(folder, "--markdown", tmp_path / "report.md") == 2
    assert "episodes.jsonl, line 3: the checksum ('crc') does not fit" in capsys.readouterr().err
    assert not (tmp_path / "report.md").exists()


def test_two_versions_are_named_and_warned_of(folder, capsys):
    RecordFile(folder).append(episode("c", library_version="9.9"))
    assert report(folder) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "several versions of the library, which may differ in what they do: 0 (6 episodes), 9.9 (1" in told


def test_two_configurations_are_an_error_that_names_what_differs(folder, capsys):
    RecordFile(folder).append(failed("b", "Random", 50, config_hash="other"))
    (folder / "settings").mkdir()
    for name, steps in (("abc", 500), ("other", 400)):
        settings = {"max_steps": steps, "world": {"mass_scale": 1}}
        (folder / "settings" / f"{name}.json").write_text(json.dumps(settings))
    assert report(folder) == 2
    assert "(max_steps: 500 in the first, 400 in the other)" in capsys.readouterr().err


def test_settings_that_cannot_be_read_do_not_hide_the_difference(folder, capsys):
    RecordFile(folder).append(failed("b", "Random", 50, config_hash="other"))
    (folder / "settings").mkdir()
    (folder / "settings" / "abc.json").write_text("{")
    assert report(folder) == 2
    assert "(config_hash abc and other)" in capsys.readouterr().err


def test_a_line_of_brackets_is_damage(folder, capsys):
    path = folder / "episodes.jsonl"
    path.write_bytes(path.read_bytes() + b"[" * 200_000 + b"\n")
    assert report(folder) == 2
    assert "episodes.jsonl, line 7: not a JSON record" in capsys.readouterr().err


def test_failed_episodes_are_told(folder, capsys):
    known = ("error", "task", "heuristic", "irot", 0, "WorldError", "no room", "", "0")
    FailureFile(folder).add(Failure(*known))
    assert report(folder) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "failures.jsonl: 1 episode failed with an error, in no row" in told


def test_episodes_that_were_begun_and_not_finished_are_told(folder, capsys):
    RecordFile(folder, UNFINISHED_NAME).replace([failed("z", "Random", 0), RECORDS[0]])
    assert report(folder) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "unfinished.jsonl: 1 episode cut short by a budget, in no row" in told
