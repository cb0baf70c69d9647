"""A progress bar over houses, for the commands that take minutes."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn


class HouseProgress:
    """A bar that counts houses; in a file, where no bar can move, nothing. Use as a context manager.

    An instance is a `dataset.making.parallel.Progress`.
    """

    def __init__(self, title: str, console: Console) -> None:
        self._bar = Progress(
            TextColumn(title),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("houses"),
            TimeElapsedColumn(),
            TextColumn("[dim]{task.fields[latest]}"),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(title, total=None, latest="")

    def __enter__(self) -> HouseProgress:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def __call__(self, done: int, total: int, latest: str) -> None:
        self._bar.update(self._task, completed=done, total=total, latest=latest)
