"""The parent's end of the connection to a worker, and what a worker is to it."""

from __future__ import annotations

import threading
from multiprocessing.connection import Connection
from typing import Any, Protocol


class Wire:
    """Reads a worker's questions and sends it answers, the latter from any thread."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self._sending = threading.Lock()

    def question(self) -> tuple[int, Any] | None:
        """The next question with its number; None if the worker hung up, or was killed while it said
        something long."""
        try:
            number, question = self.connection.recv()
        except (EOFError, OSError):
            return None
        return number, question

    def answer(self, number: int, answer: object) -> None:
        """Answer a question; no use if the worker is dead."""
        with self._sending:
            if self.connection.closed:
                return
            try:
                self.connection.send((number, answer))
            except (BrokenPipeError, ConnectionResetError):
                return  # it died meanwhile, which `question` tells its reader

    def close(self) -> None:
        """Hang up."""
        with self._sending:
            self.connection.close()


class Worker(Protocol):
    """One worker process, wherever it is."""

    number: int
    """Tells it from all others of the run."""

    @property
    def wire(self) -> Wire | None:
        """The way to it; None while it has not begun."""

    def has_ended(self) -> bool:
        """Whether the process is known to be gone without ever having begun."""

    def is_killed(self) -> bool:
        """Whether the process that hung up was killed, and did not end by itself. Waits for its end."""

    @property
    def death(self) -> str:
        """How it ended, for error texts."""

    def stop(self) -> None:
        """End it without waiting for what it does."""
