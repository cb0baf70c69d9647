"""`adhoc run` with several workers: the same records, and a clean end whatever ends it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.evaluation.records import RecordFile, checked_part
from adhoc.experiments.folder_lock import locked

SHORT = ("policy=irot", "join_step=3", "limit=2", "max_steps=25", "pictures=false", "transcript=false")
LONG = ("policy=random", "team.agent._target_=adhoc.agents.random_policy.RandomPolicy", "pictures=false")
PATIENCE_S = 120.0


def records_of(folder):
    return {record["episode_id"]: checked_part(record) for record in RecordFile(folder).read()}


def wait_until(is_so):
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.05)


class Run:
    """A run of two workers in a process group of its own."""

    def __init__(self, out: Path) -> None:
        command = [sys.executable, "-m", "adhoc.cli.main", "run", *LONG, "workers=2", f"out={out}"]
        self.process = subprocess.Popen(
            command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        self.group = self.process.pid
        wait_until(lambda: (out / "episodes.jsonl").exists())

    def is_gone(self) -> bool:
        try:
            os.killpg(self.group, 0)
        except ProcessLookupError:
            return True
        return False


@pytest.fixture
def run(tmp_path):
    begun = Run(tmp_path / "out")
    yield begun
    if not begun.is_gone():
        os.killpg(begun.group, signal.SIGKILL)
    begun.process.communicate()


def test_the_records_are_those_of_one_process(tmp_path):
    assert main(["run", *SHORT, f"out={tmp_path}/one"]) == 0
    assert main(["run", *SHORT, "workers=2", f"out={tmp_path}/two"]) == 0
    assert len(records_of(tmp_path / "one")) == 4
    assert records_of(tmp_path / "two") == records_of(tmp_path / "one")


def test_pictures_and_transcripts_are_written_by_workers(tmp_path):
    assert main(["run", *SHORT[:-2], "limit=1", "workers=2", f"out={tmp_path}"]) == 0
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 2
    assert len(list((tmp_path / "transcripts").glob("*.md"))) == 1


def test_a_wrong_value_gives_the_line_that_one_process_gives(tmp_path, capfd):
    lines = []
    for workers in (1, 2):
        options = ("policy.generator.n=0", f"workers={workers}", f"out={tmp_path}")
        assert main(["run", *SHORT, *options]) == 2
        lines.append(capfd.readouterr().err)
    assert lines[0] == lines[1]
    assert lines[0].count("\n") == 1


def test_there_must_be_a_worker(tmp_path, capsys):
    assert main(["run", *SHORT, "workers=0", f"out={tmp_path}"]) == 2
    assert "workers=0: must be at least 1" in capsys.readouterr().err


def test_a_second_run_in_one_folder_is_refused(tmp_path, capsys):
    with locked(tmp_path):
        assert main(["run", *SHORT, f"out={tmp_path}"]) == 2
    captured = capsys.readouterr().err
    assert "is writing to this folder" in captured
    assert captured.count("\n") == 1
    assert not (tmp_path / "episodes.jsonl").exists()


def test_an_interruption_ends_the_run_and_all_workers_in_one_line(run):
    os.killpg(run.group, signal.SIGINT)
    _, told = run.process.communicate(timeout=PATIENCE_S)
    assert run.process.returncode == 130
    lines = [line for line in told.splitlines() if not line.startswith("pybullet build time")]
    assert lines == ["adhoc run: interrupted; the same command goes on where it stopped"]
    wait_until(run.is_gone)


def test_workers_do_not_outlive_a_killed_parent(run):
    run.process.kill()
    run.process.wait()
    wait_until(run.is_gone)
