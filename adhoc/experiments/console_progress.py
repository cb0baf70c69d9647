"""Telling a person how far a run is: a live part in a terminal, plain lines elsewhere."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.text import Text

from adhoc.core.counting import counted
from adhoc.evaluation.records import Record
from adhoc.experiments.failures import Failure
from adhoc.experiments.plan import Plan
from adhoc.experiments.tally import Tally

PARTS = 10
"""So often success so far is told where nothing is live, but not before so many episodes."""


class ConsoleProgress:
    """Prints the plan, one line for each episode that ends, and success at the end. In a terminal it shows
    what is running, how fast, for how long still, for how much, and with what success so far; elsewhere
    the lines tell that, and success now and then.

    Use as a context manager; see `progress.Progress` for the methods.

    Args:
        console: Where to print; standard output by default.
        live: Whether to show what is running; not while a person types at the same terminal.
    """

    def __init__(self, console: Console | None = None, live: bool = True) -> None:
        self._console, self._is_live = console or Console(), live
        self._tally: Tally | None = None
        self._running = ""
        self._live = Live(console=self._console, refresh_per_second=4, transient=True)

    def __enter__(self) -> ConsoleProgress:
        if self._console.is_terminal and self._is_live:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live.is_started:
            self._live.stop()
        if self._tally is not None and self._tally.run:
            self._print(f"success in this run: {', '.join(self._tally.success())}", "dim")

    def begin(self, plan: Plan) -> None:
        """See `Progress`."""
        self._tally = Tally(plan)
        missing = ", ".join(f"{label} {count}" for label, count in plan.missing.items() if count)
        self._print(
            f"{counted(self._tally.total, 'episode')} in {counted(plan.scenarios, 'scenario')}; "
            f"recorded: {plan.done}; "
            f"to run: {plan.to_run}" + (f" ({missing})" if missing else ""),
            "bold",
        )
        if plan.models:
            cost = f"; by those recorded, ${plan.usd:.2f} more" if plan.usd else ""
            self._print(f"they ask {', '.join(plan.models)}{cost}", "dim")

    def started(self, episode_id: str) -> None:
        """See `Progress`."""
        self._running = episode_id
        self._show()

    def finished(self, record: Record) -> None:
        """See `Progress`."""
        assert self._tally is not None
        self._tally.add(record)
        outcome = "success" if record["success"] else record["ending"]
        self._say(
            f"{record['episode_id']}: {outcome}, {record['replaced']}/{record['misplaced']} re-placed, "
            f"{record['steps']} steps, {record['wall_s']:.1f} s",
            "green" if record["success"] else "yellow",
        )

    def failed(self, failure: Failure) -> None:
        """See `Progress`."""
        assert self._tally is not None
        self._tally.add_failed()
        self._say(f"{failure.episode_id}: failed, {failure.error}: {failure.message}", "red")

    def _say(self, line: str, style: str) -> None:
        """A line of an episode; where nothing is live, how far the run is goes before it."""
        where = str(self._tally) if not self._live.is_started else f"{self._done:>3}"
        self._print(f"{where}  {line}", style)
        self._show()
        if self._tally is not None and not self._live.is_started and self._tally.is_at_part(PARTS):
            self._print(f"success so far: {', '.join(self._tally.success())}", "dim")

    @property
    def _done(self) -> int:
        return 0 if self._tally is None else self._tally.done

    def _show(self) -> None:
        if self._tally is None or not self._live.is_started:
            return
        bar = ProgressBar(total=max(1, self._tally.total), completed=self._tally.done, width=40)
        success = ", ".join(self._tally.success())
        now = Text(f"{self._tally}   running: {self._running}", style="cyan")
        self._live.update(Group(bar, now, Text(f"success so far: {success}" if success else "")))

    def _print(self, line: str, style: str) -> None:
        self._console.print(Text(line, style=style), soft_wrap=True)
