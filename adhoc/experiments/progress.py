"""Telling a person how far a run is: a live line in a terminal, plain lines elsewhere."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.text import Text

from adhoc.evaluation.records import Record


class ConsoleProgress:
    """Prints one line per finished episode, and in a terminal what is running now.

    Use as a context manager; see `run.Progress` for the methods.

    Args:
        console: Where to print; standard output by default.
        live: Whether to show what is running; not while a person types at the same terminal.
    """

    def __init__(self, console: Console | None = None, live: bool = True) -> None:
        self._console, self._is_live = console or Console(), live
        self._total = self._done = 0
        self._live = Live(console=self._console, refresh_per_second=8, transient=True)

    def __enter__(self) -> ConsoleProgress:
        if self._console.is_terminal and self._is_live:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live.is_started:
            self._live.stop()

    def begin(self, episodes: int) -> None:
        """See `run.Progress`."""
        self._total, self._done = episodes, 0

    def skipped(self, record: Record) -> None:
        """See `run.Progress`."""
        self._done += 1
        self._say(f"{record['episode_id']}: already recorded", "dim")

    def started(self, episode_id: str) -> None:
        """See `run.Progress`."""
        self._live.update(Text(f"  ... {self._done + 1}/{self._total}  {episode_id}", style="cyan"))

    def finished(self, record: Record) -> None:
        """See `run.Progress`."""
        self._done += 1
        outcome = "success" if record["success"] else record["ending"]
        self._say(
            f"{record['episode_id']}: {outcome}, {record['replaced']}/{record['misplaced']} re-placed, "
            f"{record['steps']} steps, {record['wall_s']:.1f} s",
            "green" if record["success"] else "yellow",
        )

    def _say(self, line: str, style: str) -> None:
        text = f"{self._done:>3}/{self._total}  {line}"
        self._console.print(Text(text, style=style), soft_wrap=True)
