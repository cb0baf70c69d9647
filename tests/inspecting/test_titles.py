"""What episodes that are shown together are called, on pages, in films and in pictures."""

from __future__ import annotations

import pytest

from adhoc.inspecting.titles import titles


def record(join_step=None, label="IRoT", model=None, team="Heuristic"):
    return {
        "join_step": join_step,
        "policy": "irot",
        "policy_label": label,
        "model": model,
        "team_label": team,
    }


@pytest.mark.parametrize(
    ("records", "told"),
    [
        ([record(), record(50)], ["team alone", "with IRoT"]),
        ([record(), record(0), record(50)], ["team alone", "with IRoT t0", "with IRoT t50"]),
        ([record(0, model="a"), record(0, model="b")], ["with IRoT a", "with IRoT b"]),
        ([record(), record(team="LLM")], ["team alone beside Heuristic", "team alone beside LLM"]),
        ([record(0), record(0)], ["with IRoT #1", "with IRoT #2"]),
        ([record(0), record(0, "CoT"), record(50)], ["with IRoT t0", "with CoT", "with IRoT t50"]),
    ],
)
def test_as_much_is_added_as_tells_them_apart(records, told):
    assert titles(records) == told


def test_the_team_alone_may_be_called_otherwise():
    assert titles([record(), record(3)], "original team") == ["original team", "with IRoT"]
