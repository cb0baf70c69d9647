"""Folders of others are checked and looked into without running what they name."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.cli.trust import check_trusted
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.provenance.file import provenance_files, read_provenance, write_provenance


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made") / "run"
    options = ["policy=none", "benchmark=demo", "limit=1", "max_steps=3", "pictures=false"]
    assert main(["run", *options, f"out={folder}"]) == 0
    return folder


@pytest.fixture
def evil(made, tmp_path, monkeypatch):
    """The folder as one could send it: its benchmark is a function that leaves a file."""
    (path,) = provenance_files(made)
    facts = read_provenance(made, path.stem)
    target = {"_target_": "os.system", "command": f"touch {tmp_path / 'taken'}"}
    forged = replace(facts, config={**facts.config, "benchmark": target})
    folder = tmp_path / "evil"
    write_provenance(folder, forged)
    RecordFile(folder).replace([{**it, "run": forged.run} for it in RecordFile(made).read()])
    (folder / "settings").symlink_to(made / "settings")
    monkeypatch.chdir(tmp_path)
    return folder


def test_a_folder_of_the_library_needs_no_trust(made, capsys):
    assert main(["verify", str(made), "--replay", "1"]) == 0
    assert main(["inspect", str(made), RecordFile(made).read()[0]["episode_id"]]) == 0
    assert "written: " in capsys.readouterr().out


def test_verify_builds_nothing_of_others(evil, tmp_path, capsys):
    assert main(["verify", str(evil)]) == 1
    assert "benchmark._target_=os.system: is no class of this library; --trust" in capsys.readouterr().out
    assert not (tmp_path / "taken").exists()


def test_inspect_builds_nothing_of_others(evil, tmp_path, capsys):
    assert main(["inspect", str(evil), RecordFile(evil).read()[0]["episode_id"]]) == 2
    assert "benchmark._target_=os.system: is no class of this library; --trust" in capsys.readouterr().err
    assert not (tmp_path / "taken").exists()


def test_a_module_beside_the_folder_is_not_imported(made, tmp_path, monkeypatch, capsys):
    Path(tmp_path, "beside.py").write_text(f"open({str(tmp_path / 'taken')!r}, 'w')")
    (path,) = provenance_files(made)
    facts = read_provenance(made, path.stem)
    write_provenance(tmp_path, replace(facts, config={**facts.config, "world": {"_target_": "beside.World"}}))
    RecordFile(tmp_path).replace(RecordFile(made).read())
    monkeypatch.chdir(tmp_path)
    assert main(["verify", "."]) == 1
    assert "world._target_=beside.World: is no class of this library" in capsys.readouterr().out
    assert not (tmp_path / "taken").exists()


@pytest.mark.parametrize(
    "target",
    [
        "subprocess.run",
        "adhoc.core.whole_file.write_whole",
        "adhoc.cli.main.main",
        "adhoc.core.whole_file.Path",
        "adhoc_evil.World",
        3,
        None,
    ],
)
@pytest.mark.parametrize("nest", [lambda it: {"a": it}, lambda it: {"a": {"b": [1, [it]]}}])
def test_only_classes_that_are_defined_here_are_built(target, nest):
    with pytest.raises(ConfigurationError, match="is no class of this library"):
        check_trusted(nest({"_target_": target}))


def test_every_shipped_choice_is_of_the_library():
    for path in Path(__file__).parents[2].glob("configs/**/*.yaml"):
        for line in path.read_text(encoding="utf-8").splitlines():
            name, _, target = line.strip().partition(": ")
            if name == "_target_":
                check_trusted(json.loads(json.dumps({"a": {"_target_": target}})))
