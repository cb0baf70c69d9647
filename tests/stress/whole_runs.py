"""Runs of `adhoc run` in processes of their own, which are killed and begun again until they are done."""

from __future__ import annotations

import time
import warnings
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from random import Random

from http_model import URL
from processes import ForkedRun, RunProcess, new_run

from adhoc.evaluation.records import RecordFile, TornRecordWarning, checked_part
from adhoc.llm.ledger.entry import Answer, Call
from adhoc.llm.ledger.reader import TornLedgerWarning, ledger_files
from adhoc.testing.loopback_provider import LoopbackProvider

DELAYS_S = (0.0, 0.01, 0.04)
"""What the provider takes for a reply, in turn."""
SMALL = (
    "policy=irot",
    "join_step=3",
    "max_steps=40",
    "limit=4",
    "pictures=false",
    "transcript=false",
    "llm._target_=http_model.HttpModel",
)
"""Eight short episodes in the two smallest of the shipped houses."""
ENDED_BY_ITSELF_S = 240.0
STARTING_S = 3.0
CALLS_BETWEEN_KILLS = 8


def provider() -> LoopbackProvider:
    """A provider that is slow enough to be killed during a call."""
    return LoopbackProvider(delay=lambda number: DELAYS_S[number % len(DELAYS_S)])


def start(folder: Path, url: str, overrides: tuple[str, ...], new: bool = True) -> RunProcess:
    """`adhoc run` in a process of its own, of a new interpreter or of one that has imported everything; what
    it says goes to `output` beside the folder."""
    begin = new_run if new else ForkedRun
    return begin(["run", *overrides, f"out={folder}"], {URL: url}, folder.with_suffix(".output"))


def finish(process: RunProcess, folder: Path) -> None:
    """Wait for the end of a run, which must be a good one."""
    assert process.wait(ENDED_BY_ITSELF_S) == 0, folder.with_suffix(".output").read_text()[-2000:]


@dataclass(frozen=True)
class Undisturbed:
    """What a run gives that nobody kills."""

    records: list[dict[str, object]]
    paid: Counter[str]
    """How often every request was paid, by its content."""


def run_undisturbed(folder: Path, overrides: tuple[str, ...]) -> Undisturbed:
    """The run that all others are compared with."""
    with provider() as paid:
        finish(start(folder, paid.url, overrides), folder)
        return Undisturbed(records_of(folder), paid.answered)


@dataclass
class Tally:
    """What became of killed runs. From `repaid_though_recorded` on, all must be 0."""

    runs: int = 0
    kills: int = 0
    kills_at_any_time: int = 0
    """Of new interpreters, from their first moment on; the others came soon after a call."""
    in_flight: int = 0
    """Calls without an answer in the ledger when their process was killed."""
    calls: int = 0
    repaid: int = 0
    """Calls that the provider answered more often than in the undisturbed run."""
    repaid_though_recorded: int = 0
    """Calls that were made although their answer was in the ledger."""
    unexplained: int = 0
    """Paid calls that are neither in the ledger nor were in flight at a kill."""
    lost: int = 0
    doubled: int = 0
    different: int = 0
    unknown_calls: int = 0
    """Contents that the undisturbed run did not ask for, or asked for more often."""

    def add(self, other: Tally) -> None:
        """Sum up."""
        for name, value in vars(other).items():
            setattr(self, name, getattr(self, name) + value)

    def check(self) -> None:
        """The promise: what was recorded is not paid again, and nothing is lost."""
        assert self.repaid <= self.in_flight, self
        wrong = ("repaid_though_recorded", "unexplained", "lost", "doubled", "different", "unknown_calls")
        assert not any(getattr(self, name) for name in wrong), self


def run_killed(
    folder: Path, overrides: tuple[str, ...], chance: Random, most_kills: int, expected: Undisturbed
) -> Tally:
    """Begin a run again and again, kill it `most_kills` times at most, and compare what it leaves."""
    tally = Tally(runs=1)
    with provider() as paid:
        while tally.kills < most_kills:
            any_time = chance.random() < 0.25
            process = start(folder, paid.url, overrides, new=any_time)
            _wait_for_a_moment(process, paid, chance, any_time)
            if process.poll() is not None:
                finish(process, folder)
                break
            process.kill()
            process.wait()
            tally.kills += 1
            tally.kills_at_any_time += any_time
        else:
            finish(start(folder, paid.url, overrides), folder)
        while paid.at_once:
            time.sleep(0.01)
        _compare(tally, folder, paid.answered, expected)
    return tally


def records_of(folder: Path) -> list[dict[str, object]]:
    """The records by episode, without what may differ."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TornRecordWarning)
        records = [checked_part(record) for record in RecordFile(folder).read()]
    return sorted(records, key=lambda record: str(record["episode_id"]))


def _wait_for_a_moment(process: RunProcess, paid: LoopbackProvider, chance: Random, any_time: bool) -> None:
    """Any time after the start, or soon after some further call."""
    if any_time:
        _wait(process, time.monotonic() + chance.uniform(0.0, STARTING_S), paid, None)
        return
    calls = len(paid.calls) + chance.randint(1, CALLS_BETWEEN_KILLS)
    _wait(process, time.monotonic() + ENDED_BY_ITSELF_S, paid, calls)
    _wait(process, time.monotonic() + chance.uniform(0.0, 0.06), paid, None)


def _wait(process: RunProcess, end: float, paid: LoopbackProvider, calls: int | None) -> None:
    while process.poll() is None and time.monotonic() < end and (calls is None or len(paid.calls) < calls):
        time.sleep(0.002)


def _compare(tally: Tally, folder: Path, paid: Counter[str], expected: Undisturbed) -> None:
    answered: set[str] = set()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TornLedgerWarning)
        for file in ledger_files(folder / "ledger"):
            under_way: set[str] = set()
            for _, entry in file.entries():
                if isinstance(entry, Call):
                    tally.repaid_though_recorded += entry.key in answered
                    under_way.add(entry.key)
                elif isinstance(entry, Answer):
                    answered.add(entry.key)
                    under_way.discard(entry.key)
            tally.in_flight += len(under_way)
    tally.calls += paid.total()
    tally.repaid += paid.total() - expected.paid.total()
    tally.unexplained += max(0, paid.total() - len(answered) - tally.in_flight)
    tally.unknown_calls += len(set(paid) ^ set(expected.paid)) + sum((expected.paid - paid).values())
    records = records_of(folder)
    ids = Counter(str(record["episode_id"]) for record in records)
    tally.doubled += ids.total() - len(ids)
    tally.lost += len({str(record["episode_id"]) for record in expected.records} - set(ids))
    tally.different += records != expected.records
