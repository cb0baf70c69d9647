"""`adhoc verify --replay` of a run whose model was paid: the ledger answers, and nobody is asked."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from paid_model import PaidReasoner

from adhoc.cli.main import main
from adhoc.experiments.provenance.file import provenance_files, read_provenance


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        overrides = (
            "policy=irot llm._target_=paid_model.PaidReasoner max_steps=30 pictures=false transcript=false "
            "benchmark.draws=[{house:one_room,seed:1,misplaced:2,teammates:3}] out=results"
        )
        assert main(["run", *overrides.split()]) == 0
    return folder / "results"


@pytest.fixture
def results(made, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(made, "results")
    PaidReasoner.calls.clear()
    return Path("results")


def verify(capsys):
    code = main(["verify", "--trust", "results", "--replay", "2"])
    return code, capsys.readouterr().out.splitlines()


def test_the_session_tells_who_was_asked_and_when(results):
    (path,) = provenance_files(results)
    facts = read_provenance(results, path.stem)
    (session,) = facts.sessions
    (name,) = session["models"]
    asked = session["models"][name]
    assert name == "paid"
    assert asked["reported"] == {"paid": asked["answers"]}
    assert session["started"] <= asked["first"] <= asked["last"] <= session["ended"]
    assert set(facts.code["modules"]) == {"paid_model"}


def test_episodes_are_replayed_from_the_ledger(results, capsys):
    code, lines = verify(capsys)
    assert code == 0
    assert lines[-1] == "results: 2 of 2 episodes that were run again have the same records"
    assert PaidReasoner.calls == []


def test_without_the_ledger_nothing_is_asked_and_the_lack_is_told(results, capsys):
    shutil.rmtree("results/ledger")
    code, lines = verify(capsys)
    assert code == 1
    assert any("ledger" in line for line in lines), lines
    assert PaidReasoner.calls == []
