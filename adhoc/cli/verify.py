"""`adhoc verify DIR...`: whether run folders are whole, and all numbers in them follow from the records."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from adhoc.cli import report
from adhoc.cli.hydra_run import make_importable
from adhoc.cli.trust import add_trust
from adhoc.cli.verify_plan import RebuiltRun
from adhoc.cli.verify_replay import chosen, replay_findings
from adhoc.cli.verify_tables import table_findings
from adhoc.core.counting import counted
from adhoc.core.errors import ConfigurationError
from adhoc.experiments.provenance.file import Provenance, read_provenance
from adhoc.experiments.verifying.folder import verify_folder
from adhoc.experiments.verifying.origin import RunPlan

DESCRIPTION = """\
Checks run folders: the checksum of every record and of every recorded call; that every derived number follows
from the records; that settings, provenance and tables are those of the records; that no planned episode is
missing. One line for each fault. The exit code is 1 if there is any."""
FAULTY = 1


def main(arguments: Sequence[str]) -> int:
    """Verify; returns the exit code. Raises AdhocError for folders that are none."""
    options = _parse(arguments)
    moved = dict(_moved(text) for text in options.file)
    if options.trust:
        make_importable(Path.cwd())
    faults = sum(_verify(Path(folder), options, moved) for folder in options.folders)
    return FAULTY if faults else 0


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="adhoc verify", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument(
        "--replay",
        type=int,
        default=0,
        metavar="N",
        help="run N episodes again, too, and compare their records",
    )
    parser.add_argument("--seed", type=int, default=0, help="which episodes --replay draws (0)")
    parser.add_argument(
        "--file",
        action="append",
        default=[],
        metavar="KEY=PATH",
        help="where a file is here that the configuration names, as benchmark.path=houses.jsonl.gz",
    )
    add_trust(parser)
    options = parser.parse_args(list(arguments))
    if options.replay < 0:
        raise ConfigurationError(f"--replay {options.replay}: must be at least 0")
    return options


def _moved(text: str) -> tuple[str, str]:
    key, separator, path = text.partition("=")
    if not separator or not key or not path:
        raise ConfigurationError(f"--file {text}: must be KEY=PATH, as benchmark.path=houses.jsonl.gz")
    return key, path


def _verify(folder: Path, options: argparse.Namespace, moved: Mapping[str, str]) -> int:
    """Print what is found, and return how many of it are faults."""
    with ExitStack() as stack:
        runs = _Runs(folder, moved, options.trust, stack)
        verified = verify_folder(folder, runs.plan)
        findings = list(verified.findings)
        if not verified.faults:
            findings += table_findings(folder, report.main)
        for finding in findings:
            _say(f"{folder}/{finding}" if finding.is_fault else f"{folder}: {finding}")
        faults = sum(finding.is_fault for finding in findings)
        _say(f"{folder}: {_told(len(verified.records), faults, runs.count)}")
        picked = chosen(verified.records, options.replay, options.seed)
        same = 0
        for different in replay_findings(folder, picked, verified.records, runs.rebuilt):
            if different is None:
                same += 1
            else:
                faults += 1
                _say(f"{folder}/{different}")
        if picked:
            _say(f"{folder}: {same} of {len(picked)} episodes that were run again have the same records")
    return faults


class _Runs:
    """The runs of a folder, each built again once."""

    def __init__(self, folder: Path, moved: Mapping[str, str], trust: bool, stack: ExitStack) -> None:
        self._folder, self._moved, self._trust, self._stack = folder, moved, trust, stack
        self._built: dict[str, RebuiltRun] = {}
        self.count = 0

    def plan(self, facts: Provenance) -> RunPlan:
        self.count += 1
        with ExitStack() as stack:
            rebuilt = RebuiltRun(self._folder, facts, self._moved, self._trust)
            stack.callback(rebuilt.close)
            return rebuilt.plan()

    def rebuilt(self, run: str) -> RebuiltRun:
        if run not in self._built:
            facts = read_provenance(self._folder, run)
            rebuilt = RebuiltRun(self._folder, facts, self._moved, self._trust)
            self._stack.callback(rebuilt.close)
            self._built[run] = rebuilt
        return self._built[run]


def _told(records: int, faults: int, runs: int) -> str:
    verdict = counted(faults, "fault") if faults else "no faults"
    return f"{counted(records, 'record')} of {counted(runs, 'run')} checked, {verdict}"


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
