"""What runs cost beside their episodes: orchestration, a second worker, memory.

    python benchmarks/runs.py [SCENARIOS]

The team alone and IRoT in so many tasks of the paper's benchmark (250 by default: 500 episodes), once in
one worker process and once in two, on the same machine in one go. Orchestration is the time of the one worker
in which no episode is run, from the first episode to the last, as a share of the whole; memory is that of the
largest worker after 100 episodes of each and after the last.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

from adhoc.evaluation.records import FILE_NAME, RecordFile

RUN = ("policy=irot", "team=heuristic", "benchmark=paper", "pictures=false", "transcript=false")
WARM = 100
"""Episodes of each worker after which it has loaded and compiled everything, and met large houses."""
ALIVE_MB = 100.0
"""A process with less memory is no worker, or is ending."""
LOOK_S = 0.5


@dataclass(frozen=True)
class Measured:
    """One run, from its first finished episode to its last."""

    episodes: int
    seconds: float
    in_episodes: float
    memory: tuple[float, float]
    """Of the largest worker in MB, warm and at the end."""
    whole: float
    """Seconds from command to exit."""

    @property
    def rate(self) -> float:
        """Episodes a second."""
        return self.episodes / self.seconds


def measure(workers: int, scenarios: int, folder: Path) -> Measured:
    """Run, and watch the run folder and the workers."""
    command = [sys.executable, "-m", "adhoc.cli.main", "run", *RUN, "executor=processes"]
    begun = time.perf_counter()
    process = subprocess.Popen(
        [*command, f"workers={workers}", f"limit={scenarios}", f"out={folder}"], stdout=subprocess.DEVNULL
    )
    first = last = begun
    done, warm, full = 0, 0.0, 0.0
    while process.poll() is None:
        lines = _lines(folder / FILE_NAME)
        if lines > done:
            now = time.perf_counter()
            first, last = (now if not done else first), now
            if done < WARM * workers <= lines:
                warm = _largest_worker(process.pid)
            now_full = _largest_worker(process.pid)
            full = now_full if now_full > ALIVE_MB else full
            done = lines
        time.sleep(LOOK_S)
    if process.returncode:
        raise SystemExit(f"the run ended with exit code {process.returncode}")
    whole = time.perf_counter() - begun
    records = RecordFile(folder).read()
    in_episodes = sum(float(record["wall_s"]) for record in records[1:])
    return Measured(len(records) - 1, last - first, in_episodes, (warm, full), whole)


def _lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


def _largest_worker(parent: int) -> float:
    return max((_memory(pid) for pid in _children(parent)), default=0.0)


def _children(parent: int) -> Iterator[int]:
    for path in Path(f"/proc/{parent}/task").glob("*/children"):
        yield from map(int, path.read_text().split())


def _memory(pid: int) -> float:
    try:
        text = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0
    found = [line.split()[1] for line in text.splitlines() if line.startswith("VmRSS")]
    return int(found[0]) / 1024 if found else 0.0


def main() -> None:
    """Measure and print."""
    scenarios = int(sys.argv[1]) if len(sys.argv) > 1 else 250
    with tempfile.TemporaryDirectory(prefix="adhoc-bench-") as folder:
        one, two = (measure(workers, scenarios, Path(folder) / str(workers)) for workers in (1, 2))
    table = Table(title=f"{2 * scenarios} episodes of the paper's benchmark, offline model")
    for column in (
        "workers",
        "episodes/s",
        "in episodes",
        "beside them",
        "memory warm",
        "at the end",
        "whole",
    ):
        table.add_column(column, justify="right")
    for workers, it in ((1, one), (2, two)):
        share = it.in_episodes / (it.seconds * workers)
        table.add_row(
            str(workers),
            f"{it.rate:.2f}",
            f"{share:.1%}",
            f"{1 - share:.1%}",
            f"{it.memory[0]:.0f} MB",
            f"{it.memory[1]:.0f} MB",
            f"{it.whole:.0f} s",
        )
    console = Console()
    console.print(table)
    console.print(f"two workers do {two.rate / one.rate:.2f} times the episodes of one")
    console.print(
        f"the paper's 1350 tasks, alone and with IRoT, take about {2700 / two.rate / 60:.0f} minutes"
    )


if __name__ == "__main__":
    main()
