"""100 kills of single workers at random moments: the parent owns the calls, so that none is paid twice."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random, SystemRandom

import pytest
from http_model import URL
from whole_runs import SMALL, provider, records_of, run_undisturbed

from adhoc.cli.main import main
from adhoc.experiments.workers import parent
from adhoc.testing.loopback_provider import LoopbackProvider

KILLS, KILLS_OF_A_RUN, MOST_RUNS = 100, 12, 60
ANY_TIME_S = 3.0
CALLS_BETWEEN_KILLS = 8

pytestmark = pytest.mark.timeout(3600)


@pytest.fixture(autouse=True)
def here(monkeypatch):
    monkeypatch.chdir(Path(__file__).parent)
    monkeypatch.setattr(parent, "DEATHS", 10**6)


def workers_of_this_process() -> list[int]:
    """Their process ids; read from the system, because `active_children` is for the parent's thread alone."""
    children = Path(f"/proc/{os.getpid()}/task").glob("*/children")
    found = sorted({int(child) for path in children for child in path.read_text().split()})
    return [child for child in found if b"spawn_main" in _command(child)]


def _command(process: int) -> bytes:
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return b""


@dataclass
class Killing:
    """What was done to the workers of one run, and what it cost."""

    kills: int = 0
    during_calls: int = 0
    """Kills while the provider was at a call of one of the workers."""
    paid: Counter[str] = field(default_factory=Counter)


def run_with_kills(folder: Path, chance: Random, most: int, monkeypatch) -> Killing:
    """A run with two workers of this process, of which one is killed now and then."""
    over, done = threading.Event(), Killing()

    def kill():
        while done.kills < most and not over.is_set():
            _wait_for_a_moment(paid, chance, over)
            workers = workers_of_this_process()
            if workers:
                during_a_call = paid.at_once > 0
                with contextlib.suppress(ProcessLookupError):
                    os.kill(chance.choice(workers), signal.SIGKILL)
                    done.kills += 1
                    done.during_calls += during_a_call

    with provider() as paid:
        monkeypatch.setenv(URL, paid.url)
        killer = threading.Thread(target=kill)
        killer.start()
        try:
            assert main(["run", *SMALL, "workers=2", f"out={folder}"]) == 0
        finally:
            over.set()
            killer.join()
        done.paid = paid.answered
    return done


def _wait_for_a_moment(paid: LoopbackProvider, chance: Random, over: threading.Event) -> None:
    """A quarter of the kills come at any time, the others soon after some further call."""
    if chance.random() < 0.25:
        over.wait(chance.uniform(0.0, ANY_TIME_S))
        return
    calls = len(paid.calls) + chance.randint(1, CALLS_BETWEEN_KILLS)
    while len(paid.calls) < calls and not over.wait(0.002):
        pass
    over.wait(chance.uniform(0.0, 0.06))


def test_workers_that_are_killed_cost_nothing(tmp_path, monkeypatch):
    expected = run_undisturbed(tmp_path / "undisturbed", SMALL)
    killing = run_with_kills(tmp_path / "killed", Random(1), 3, monkeypatch)
    assert killing.kills == 3
    assert killing.paid == expected.paid
    assert records_of(tmp_path / "killed") == expected.records


@pytest.mark.stress
def test_100_kills_of_workers(tmp_path, capsys, monkeypatch):
    seed = SystemRandom().getrandbits(32)
    expected = run_undisturbed(tmp_path / "undisturbed", SMALL)
    kills = during_calls = repaid = different = runs = 0
    while kills < KILLS and runs < MOST_RUNS:
        folder = tmp_path / f"run-{runs}"
        killing = run_with_kills(folder, Random(f"{seed}-{runs}"), KILLS_OF_A_RUN, monkeypatch)
        kills, during_calls, runs = kills + killing.kills, during_calls + killing.during_calls, runs + 1
        repaid += (killing.paid - expected.paid).total()
        different += records_of(folder) != expected.records or killing.paid != expected.paid
        with capsys.disabled():
            sys.stdout.write(
                f"seed {seed}: {runs} runs of {expected.paid.total()} calls, {kills} workers killed "
                f"({during_calls} while a call was in flight), {repaid} repaid, {different} runs differ\n"
            )
    assert kills >= KILLS
    assert (repaid, different) == (0, 0)
