"""The terminal at which a person plays a robot."""

from __future__ import annotations

import io
import sys
from typing import TextIO

MAX_LINE = 1000
"""Bytes of a line; what follows counts as the next line."""


class Terminal:
    """Shows texts and reads lines; once the input has ended or the terminal is gone, nothing any more.

    Nothing is read ahead, so that several robots, and several episodes of one process, can take turns.

    Args:
        source: Where lines come from; standard input by default.
        sink: Where texts go; standard output by default.
        must_begin: Whether an input that ends before its first line is no person at all (see `is_empty`).
    """

    def __init__(
        self, source: TextIO | None = None, sink: TextIO | None = None, must_begin: bool = False
    ) -> None:
        self._source, self._sink = source or sys.stdin, sink or sys.stdout
        self._raw = _raw(self._source)
        self._is_gone = False
        self._must_begin = must_begin
        self.is_empty = False
        """Whether the input ended before its first line, where it must begin and is no terminal: at one, a
        person who ends the input at once is there all the same."""

    def show(self, text: str) -> None:
        """Write a text as it is, without a line end of its own."""
        if self._is_gone or self._sink is None:
            return
        encoding = self._sink.encoding or "utf-8"
        try:
            self._sink.write(text.encode(encoding, "replace").decode(encoding))
            self._sink.flush()
        except (OSError, ValueError):  # ValueError: it is closed
            self._is_gone = True

    def ask(self, prompt: str) -> str | None:
        """What a person types after the prompt, without its line end; None at the end of the input."""
        self.show(prompt)
        if self._is_gone:
            return None
        line = self._read_line()
        if line is None:
            self.is_empty = self._must_begin and not self._is_tty
            self.show("\n")
            return None
        self._must_begin = False
        if not self._is_tty:
            self.show(f"{line}\n")
        return line

    @property
    def _is_tty(self) -> bool:
        return self._raw is not None and self._raw.isatty()

    def _read_line(self) -> str | None:
        try:
            line = self._source.readline(MAX_LINE) if self._raw is None else self._decoded()
        except (OSError, ValueError, AttributeError):  # a terminal that was closed; no standard input at all
            return None
        return line.rstrip("\r\n") if line else None

    def _decoded(self) -> str:
        assert self._raw is not None
        return self._raw.readline(MAX_LINE).decode("utf-8", "replace")


def _raw(source: TextIO | None) -> io.FileIO | None:
    """The bytes below a text stream, unbuffered; None if it stands on no file."""
    try:
        return None if source is None else io.FileIO(source.fileno(), closefd=False)
    except (OSError, ValueError):
        return None
