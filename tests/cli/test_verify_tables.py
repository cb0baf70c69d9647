"""Tables in a run folder are written again by the command that they name."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "evaluation"))
sys.path.insert(0, str(Path(__file__).parents[1] / "reporting"))

from test_report import RECORDS

from adhoc.cli import report
from adhoc.cli.verify_tables import table_findings
from adhoc.evaluation.records import RecordFile

FILES = {"--markdown": "tables.md", "--latex": "tables.tex", "--html": "tables.html"}
ALL_FILES = [part for option, name in FILES.items() for part in (option, f"run/{name}")]


@pytest.fixture(autouse=True)
def _run_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    RecordFile("run").replace(RECORDS)


def findings(folder):
    return [str(it) for it in table_findings(folder, report.main)]


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--intervals", "--paper", "--family=report"],
        ["--power", "--difference=5", "--policy=Random"],
        ["--figures=run/figures", "--label-prefix=small"],
    ],
)
def test_whatever_was_asked_for_has_no_faults_here_and_elsewhere(options, tmp_path, monkeypatch):
    assert report.main(["run", *options, *ALL_FILES]) == 0
    assert findings(tmp_path / "run") == []
    elsewhere = tmp_path / "sent" / "received"
    shutil.move(tmp_path / "run", elsewhere)
    monkeypatch.chdir(elsewhere)
    assert findings(elsewhere) == []


@pytest.mark.parametrize("name", FILES.values())
def test_an_edited_number_is_found(name, tmp_path):
    assert report.main(["run", "--figures=run/figures", *ALL_FILES]) == 0
    path = tmp_path / "run" / name
    text = path.read_text(encoding="utf-8")
    assert "100.0 (100.0)" in text
    path.write_text(text.replace("100.0 (100.0)", "100.0 (900.0)", 1), encoding="utf-8")
    (found,) = findings(tmp_path / "run")
    assert name in found
    assert "900.0" in found


@pytest.mark.parametrize(
    ("command", "fault"),
    [
        ("adhoc report run --html stolen.html", "unrecognized arguments: --html stolen.html"),
        ("adhoc report run --figures ../stolen", "'..' names nothing in or like this folder"),
        ("adhoc report run --figures /stolen", "'/' names nothing in or like this folder"),
        ("adhoc report run --figures 'a\0b'", "names nothing in or like this folder"),
        (f"adhoc report run --figures {'x' * 300}", "names nothing in or like this folder"),
        ("adhoc report ../run", "'../run' names nothing in or like this folder"),
        ("adhoc report run --label-prefix=small", "--label-prefix small: goes with --latex"),
        ("adhoc report run other", "it was made from 2 folders, not from this one alone"),
        ("nothing", "it does not say by which `adhoc report ...` it was made"),
    ],
)
def test_a_command_is_obeyed_within_the_folder_alone(command, fault, tmp_path):
    assert report.main(["run", "--markdown=run/report.md"]) == 0
    path = tmp_path / "run" / "report.md"
    path.write_text(path.read_text(encoding="utf-8").replace("adhoc report run", command), encoding="utf-8")
    (found,) = findings(tmp_path / "run")
    assert found.endswith(fault)
    assert {it.name for it in tmp_path.iterdir()} == {"run"}


FORGED = "IRoT-LLM 99.9"


@pytest.mark.parametrize("name", ["tables.md", "tables.tex"])
def test_nothing_hides_behind_a_line_like_the_command(name, tmp_path):
    assert report.main(["run", *ALL_FILES]) == 0
    path = tmp_path / "run" / name
    text = path.read_text(encoding="utf-8")
    line = next(it for it in text.splitlines() if "adhoc report run" in it)
    forged = f"{line}\n<!-- adhoc report --> {FORGED}\n% adhoc report {FORGED}\n"
    path.write_text(text.replace("\n\n", f"\n{forged}\n", 1), encoding="utf-8")
    (found,) = findings(tmp_path / "run")
    assert "from the records of this folder it is" in found


@pytest.mark.parametrize(
    ("where", "forged"),
    [
        ('run --figures figures">', f'run --figures figures"><h1>{FORGED}</h1><i class="">'),
        ("100.0 (100.0)", f"<svg>{FORGED}<span hidden></svg>100.0 (100.0)<svg></span></svg>"),
        (
            "100.0 (100.0)",
            f'<figure role="img">{FORGED}<!-- </figure>100.0 (100.0)<figure role="img">--></figure>',
        ),
    ],
)
def test_nothing_hides_in_a_page(where, forged, tmp_path):
    assert report.main(["run", "--figures=run/figures", *ALL_FILES]) == 0
    path = tmp_path / "run" / "tables.html"
    text = path.read_text(encoding="utf-8")
    assert where in text
    path.write_text(text.replace(where, forged, 1), encoding="utf-8")
    (found,) = findings(tmp_path / "run")
    assert found.startswith("tables.html")
    assert not found.startswith("note")


def test_a_picture_that_is_drawn_otherwise_is_told_and_no_fault(tmp_path):
    assert report.main(["run", "--figures=run/figures", *ALL_FILES]) == 0
    path = tmp_path / "run" / "tables.html"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("<path d=", "<path class='mine' d=", 1), encoding="utf-8")
    assert findings(tmp_path / "run") == [
        "note: tables.html: 1 picture drawn otherwise than on this machine, and not checked"
    ]


def test_a_page_of_unended_figures_takes_no_time(tmp_path):
    assert report.main(["run", *ALL_FILES]) == 0
    path = tmp_path / "run" / "tables.html"
    path.write_text(path.read_text(encoding="utf-8") + '<figure role="img"' * 200_000, encoding="utf-8")
    (found,) = findings(tmp_path / "run")
    assert found.startswith("tables.html, line ")


def test_pictures_are_found_from_where_the_file_is(tmp_path):
    assert report.main(["run", "--figures=run/figures", "--markdown=run/tables.md"]) == 0
    links = [line for line in (tmp_path / "run/tables.md").read_text().splitlines() if line.startswith("![")]
    assert len(links) == 2
    for link in links:
        assert (tmp_path / "run" / link[link.rindex("(") + 1 : -1]).is_file()
