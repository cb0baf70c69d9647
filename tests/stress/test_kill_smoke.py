"""A taste of the kill tests for every day; the full measure is `make stress`."""

from __future__ import annotations

from random import Random

from whole_runs import SMALL, run_killed, run_undisturbed

SHORT = (*(it for it in SMALL if not it.startswith("limit=")), "limit=1", "workers=2")


def test_a_killed_run_pays_nothing_twice_and_loses_nothing(tmp_path):
    expected = run_undisturbed(tmp_path / "undisturbed", SHORT)
    assert len(expected.records) == 2
    tally = run_killed(tmp_path / "killed", SHORT, Random(4), 5, expected)
    tally.check()
    assert tally.kills >= 3
