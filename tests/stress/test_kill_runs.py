"""300 kills of whole runs at random moments, against a provider that counts what it is paid for."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from random import Random, SystemRandom

import pytest
from whole_runs import SMALL, Tally, Undisturbed, run_killed, run_undisturbed

KILLS, RUNS = 300, 10
MOST_KILLS_OF_A_RUN = 40
AT_ONCE = 2
"""Runs that go on beside each other."""

pytestmark = [pytest.mark.stress, pytest.mark.timeout(3600)]


def test_300_kills_of_whole_runs(tmp_path, capsys):
    seed = SystemRandom().getrandbits(32)
    expected = run_undisturbed(tmp_path / "undisturbed", SMALL)
    say(capsys, f"seed {seed}; undisturbed: {len(expected.records)} episodes, {expected.paid.total()} calls")
    total = Tally()
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for first in range(0, KILLS, AT_ONCE):
            if total.kills >= KILLS and total.runs >= RUNS:
                break
            numbers = range(first, first + AT_ONCE)
            for tally in pool.map(lambda number: killed(tmp_path, seed, number, expected), numbers):
                say(capsys, f"run {total.runs}: {tally}")
                tally.check()
                total.add(tally)
    say(capsys, f"in all: {total}")
    assert total.runs >= RUNS
    assert total.kills >= KILLS


def killed(folder: Path, seed: int, number: int, expected: Undisturbed) -> Tally:
    """One run; every third has two workers."""
    overrides = (*SMALL, f"workers={2 if number % 3 == 2 else 1}")
    chance = Random(f"{seed}-{number}")
    return run_killed(folder / f"run-{number}", overrides, chance, MOST_KILLS_OF_A_RUN, expected)


def say(capsys, text):
    with capsys.disabled():
        sys.stdout.write(text + "\n")
