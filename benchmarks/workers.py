"""How busy a slow provider is kept by one to six workers, as a share of the most that it takes.

A provider on loopback takes 250 ms for every answer, and two calls at once: about 8 calls a second is the
most that it can be asked. Workers also simulate between their calls, so that as many workers as calls at once
leave it idle now and then, and more workers than that do not. What counts is the time between the first and
the last quarter of the calls: workers start before it, and run out of episodes after it.

    python benchmarks/workers.py
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table

from adhoc.testing.loopback_provider import LoopbackProvider
from adhoc.testing.provider_faults import Reply

LATENCY_S = 0.25
AT_ONCE = 2
DRAWS = ",".join(f"{{house: one_room, seed: {seed}, misplaced: 2, teammates: 3}}" for seed in range(12))
RUN = (
    "policy=irot",
    "max_steps=40",
    f"benchmark.draws=[{DRAWS}]",
    "llm=litellm",
    "llm.model=openai/small",
    f"rate.concurrent={AT_ONCE}",
    "pictures=false",
    "transcript=false",
)


class Clocked(LoopbackProvider):
    """A provider that notes from when to when it was at each call."""

    def __init__(self, delay: float) -> None:
        super().__init__(delay=delay)
        self.spans: list[tuple[float, float]] = []

    def serve(self, body: bytes, authorization: str) -> Reply | None:
        """See `LoopbackProvider`."""
        begun = time.perf_counter()
        reply = super().serve(body, authorization)
        self.spans.append((begun, time.perf_counter()))
        return reply

    def middle(self) -> tuple[float, float]:
        """Calls a second, and calls at once, between the first and the last quarter of the calls."""
        begun = sorted(begin for begin, _ in self.spans)
        quarter = len(begun) // 4
        first, last = begun[quarter], begun[-quarter]
        busy = sum(max(0.0, min(end, last) - max(begin, first)) for begin, end in self.spans)
        return (len(begun) - 2 * quarter) / (last - first), busy / (last - first)


def measure(workers: int, folder: Path) -> list[str]:
    """One run: workers, calls, calls a second, the share of the provider's time that was used, seconds."""
    with Clocked(LATENCY_S) as provider:
        options = [*RUN, f"llm.api_base={provider.url}", f"workers={workers}", f"out={folder / str(workers)}"]
        begun = time.perf_counter()
        command = [sys.executable, "-m", "adhoc.cli.main", "run", *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        whole = time.perf_counter() - begun
    rate, at_once = provider.middle()
    share = at_once / AT_ONCE
    return [str(workers), str(len(provider.calls)), f"{rate:.1f}", f"{share:.0%}", f"{whole:.1f}"]


def main() -> None:
    """Measure and print."""
    table = Table(
        title=f"{AT_ONCE} calls at once of {LATENCY_S} s: at most {AT_ONCE / LATENCY_S:.0f} a second"
    )
    for heading in ("workers", "calls", "calls a second", "provider busy", "seconds in all"):
        table.add_column(heading, justify="right")
    with tempfile.TemporaryDirectory() as folder:
        for workers in (1, 2, 4, 6):
            table.add_row(*measure(workers, Path(folder)))
    Console().print(table)


if __name__ == "__main__":
    main()
