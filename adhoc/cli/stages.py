"""The stages of a training on the terminal, one line each, with a bar for those that go through houses."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console

from adhoc.cli.house_progress import HouseProgress
from adhoc.dataset.making.parallel import Progress


class Stages:
    """Shows one stage after the other. Use as a context manager."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bar: HouseProgress | None = None

    def begin(self, title: str) -> Progress:
        """A stage begins, and the one before is over; returns what counts its houses."""
        self._end()
        self._console.print(title, highlight=False)
        self._bar = HouseProgress(title, self._console)
        return self._bar.__enter__()

    def __enter__(self) -> Stages:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    def _end(self) -> None:
        if self._bar is not None:
            self._bar.__exit__(None, None, None)
            self._bar = None
