"""The same command with the same seed gives the same records, in one process and in two."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from adhoc.cli.main import main

SHORT = ["policy=irot", "join_step=5", "limit=2", "max_steps=40", "pictures=false", "transcript=false"]
WHOLE = ["policy=irot", "join_step=50", "pictures=false", "transcript=false"]


def lines_of(folder: Path) -> list[str]:
    """The record lines, with the wall-clock time blanked out."""
    lines = (folder / "episodes.jsonl").read_text(encoding="utf-8").splitlines()
    return [json.dumps({**json.loads(line), "wall_s": 0}) for line in lines]


def run_here(folder: Path, options: list[str]) -> list[str]:
    assert main(["run", *options, f"out={folder}"]) == 0
    return lines_of(folder)


def run_in_a_new_process(folder: Path, options: list[str]) -> list[str]:
    command = [sys.executable, "-m", "adhoc.cli.main", "run", *options, f"out={folder}"]
    subprocess.run(command, check=True, capture_output=True)
    return lines_of(folder)


def test_short_runs_repeat_themselves(tmp_path):
    first = run_here(tmp_path / "first", SHORT)
    assert len(first) == 4
    assert run_here(tmp_path / "second", SHORT) == first
    assert run_in_a_new_process(tmp_path / "third", SHORT) == first


def test_another_seed_gives_another_run(tmp_path):
    assert run_here(tmp_path / "first", SHORT) != run_here(tmp_path / "second", [*SHORT, "seed=7"])


@pytest.mark.slow
def test_whole_runs_repeat_themselves(tmp_path):
    first = run_here(tmp_path / "first", WHOLE)
    assert len(first) == 16
    assert run_in_a_new_process(tmp_path / "second", WHOLE) == first
