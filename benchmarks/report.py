"""How long `adhoc report` takes for 100,000 records, with everything that it can print and write.

    python benchmarks/report.py [DIR] [RECORDS]

The records are copies of those in DIR, a run folder, with other scenarios' names and their own checksums,
as if every scenario had been there many times, in 90 houses. Without DIR a few episodes are run first.
"""

from __future__ import annotations

import cProfile
import pstats
import resource
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import count, islice
from pathlib import Path
from subprocess import run

from rich.console import Console

from adhoc.evaluation.records import Record, RecordFile

RECORDS = 100_000
HOUSES = 90
EVERYTHING = ("--intervals", "--paper")
FILES = (("--markdown", "report.md"), ("--latex", "report.tex"), ("--html", "report.html"))


def main(folder: Path | None, records: int, profiled: bool) -> None:
    """Print all figures."""
    say = Console(width=110, highlight=False).print
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        if folder is None:
            folder = scratch / "run"
            _run_a_few(folder)
        many = scratch / "many"
        RecordFile(many).replace(list(islice(copies(RecordFile(folder).read()), records)))
        size = (many / "episodes.jsonl").stat().st_size
        say(f"{records:,} records, {size / 1e6:,.0f} MB")
        written = [part for option, file in FILES for part in (option, str(scratch / file))]
        for what, options in (
            ("the table", ()),
            ("with intervals, the paper's numbers and three files", (*EVERYTHING, *written)),
            ("and figures", (*EVERYTHING, *written, "--figures", str(scratch / "figures"))),
        ):
            say(f"{_seconds(many, options):6.2f} s  {what}")
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        say(f"{peak:6,.0f} MiB at most")
        if profiled:
            _profile(many, [*EVERYTHING, *written])


def copies(records: Sequence[Record]) -> Iterator[Record]:
    """The records again and again, each time in scenarios of their own; without end."""
    houses = len({record["house_id"] for record in records})
    for copy in count():
        for record in records:
            task = f"{record['task_id']}-{copy}"
            yield {
                **record,
                "episode_id": record["episode_id"].replace(record["task_id"], task, 1),
                "task_id": task,
                "house_id": f"{record['house_id']}-{copy % max(1, HOUSES // houses)}",
                "scenario_hash": f"{record['scenario_hash'][:8]}{copy:08x}",
            }


def _run_a_few(folder: Path) -> None:
    options = ["policy=none,random,heuristic,cot,irot", "join_step=0,50,100", "benchmark=sample", "limit=2"]
    quiet = ["pictures=false", "transcript=false", f"out={folder}"]
    run(
        [sys.executable, "-m", "adhoc.cli.main", "run", "-m", *options, *quiet],
        check=True,
        capture_output=True,
    )


def _seconds(folder: Path, options: Sequence[str]) -> float:
    """Of a whole process, with its imports."""
    started = time.perf_counter()
    command = [sys.executable, "-m", "adhoc.cli.main", "report", str(folder), *options]
    run(command, check=True, capture_output=True)
    return time.perf_counter() - started


def _profile(folder: Path, options: Sequence[str]) -> None:
    from adhoc.cli.report import main as report

    profile = cProfile.Profile()
    profile.runcall(report, [str(folder), *options])
    pstats.Stats(profile).sort_stats("cumulative").print_stats(40)


if __name__ == "__main__":
    arguments = [it for it in sys.argv[1:] if it != "--profile"]
    main(
        Path(arguments[0]) if arguments else None,
        int(arguments[1]) if len(arguments) > 1 else RECORDS,
        "--profile" in sys.argv,
    )
