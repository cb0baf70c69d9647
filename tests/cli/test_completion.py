from __future__ import annotations

import pytest

from adhoc.cli.main import main


def completed(line, capsys, monkeypatch):
    monkeypatch.setenv("COMP_LINE", line)
    monkeypatch.setenv("COMP_POINT", str(len(line)))
    assert main(["--shell-completion", "query=bash"]) == 0
    return capsys.readouterr().out.split()


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("adhoc rep", ["report"]),
        ("adhoc run policy=pl", ["policy=plastic"]),
        ("adhoc run policy=irot experiment=ab", ["experiment=ablation"]),
        ("adhoc run join_step=0 pict", ["pictures="]),
        ("adhoc report demo po", []),
    ],
)
def test_commands_groups_and_keys_are_offered(line, offered, capsys, monkeypatch):
    assert completed(line, capsys, monkeypatch) == offered


def test_a_shell_is_told_what_to_complete(capsys, monkeypatch):
    monkeypatch.delenv("COMP_LINE", raising=False)
    assert main(["-sc", "install=bash"]) == 0
    assert capsys.readouterr().out.rstrip().endswith("-F hydra_bash_completion adhoc")
