"""A worker's line to its parent: questions of any thread, each with its own answer."""

from __future__ import annotations

import os
import socket
import threading
from concurrent.futures import Future
from contextlib import suppress
from itertools import count
from multiprocessing.connection import Connection
from typing import Any

from adhoc.experiments.workers.messages import Raised

ORPHANED = 3
"""The exit code of a worker whose parent is gone."""


class Line:
    """Asks the parent over a connection, also from several threads at once.

    If the parent is gone, the process ends at once: nothing that it does could be stored.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._numbers = count()
        self._waiting: dict[int, Future[Any]] = {}
        self._lock = threading.Lock()
        self._is_over = False
        threading.Thread(target=self._listen, name="answers", daemon=True).start()

    def ask(self, question: object) -> Any:
        """The answer to a question of `messages`. Raises the AdhocError that the parent answers with."""
        answered: Future[Any] = Future()
        with self._lock:
            number = next(self._numbers)
            self._waiting[number] = answered
            try:
                self._connection.send((number, question))
            except (BrokenPipeError, ConnectionResetError):
                os._exit(ORPHANED)
        answer = answered.result()
        if isinstance(answer, Raised):
            raise answer.error()
        return answer

    def hang_up(self) -> None:
        """Say nothing more. For a process that lives on; the connection must be a socket's."""
        self._is_over = True
        with socket.socket(fileno=os.dup(self._connection.fileno())) as end, suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)  # unlike `close`, wakes the thread that listens

    def _listen(self) -> None:
        while True:
            try:
                number, answer = self._connection.recv()
            except (EOFError, OSError):
                if self._is_over:
                    self._connection.close()
                    return
                os._exit(ORPHANED)
            with self._lock:
                answered = self._waiting.pop(number)
            answered.set_result(answer)
