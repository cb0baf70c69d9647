"""Scripts: what a person types, in a file. The log of a session is one."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import ConfigurationError

MAX_BYTES = 10_000_000
"""A longer file is no script."""
_STAMP = re.compile(r"@(\d{1,9})(?::([0-9a-f]+))?(?: (.*))?")


@dataclass(frozen=True)
class Line:
    """What was typed, when (a step; None for whenever the robot asks), and in which situation."""

    text: str
    step: int | None = None
    situation: str | None = None

    def __str__(self) -> str:
        stamp = "" if self.step is None else f"@{self.step}"
        return f"{stamp}:{self.situation} {self.text}" if self.situation else f"{stamp} {self.text}".lstrip()


@dataclass(frozen=True)
class Answer:
    """What a script gives a robot that asks: a line, or nothing yet (`text` is empty, `is_typed` False)."""

    text: str
    is_typed: bool = True
    is_strayed: bool = False
    """Whether it was typed in another situation than this."""


class Script:
    """The lines of a file, handed out as they are asked for.

    A line that was recorded in the very situation in which the robot asks is given at once, wherever it is;
    the next ones then come from behind it. Where a situation is new, the next line is given in its place, but
    not before its step.

    Args:
        path: The file (see `docs/human.md`).
        key: What the file was given by, for errors.

    Raises:
        ConfigurationError: It cannot be read, or a line of it is malformed.
    """

    def __init__(self, path: Path, key: str = "script") -> None:
        self._path, self._key = path, key
        self._sections = read_script(path, key)
        self._places: dict[str, tuple[int, int]] = {}
        for section, lines in enumerate(self._sections):
            for index, line in enumerate(lines):
                if line.situation is not None:
                    self._places[line.situation] = (section, index)
        self._next: tuple[int, int] | None = None

    @property
    def fingerprint(self) -> str:
        """A hash of its lines, whatever comments stand between them."""
        text = "\n\n".join("\n".join(map(str, lines)) for lines in self._sections)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def begin(self) -> None:
        """Begin again, with another episode."""
        self._next = None

    def recorded(self, situation: str) -> str | None:
        """What was typed in this situation, None if it was never met."""
        place = self._places.get(situation)
        return None if place is None else self._sections[place[0]][place[1]].text

    def answer(self, step: int, situation: str) -> Answer | None:
        """What comes next; None when the script is at its end.

        Raises ConfigurationError if it is the log of other episodes than this.
        """
        place = self._places.get(situation) or self._next or self._beginning()
        line = self._line(place)
        if line is None:
            return None
        if situation in self._places:
            self._next = (place[0], place[1] + 1)
            return Answer(line.text)
        if line.step is not None and step < line.step:
            self._next = place
            return Answer("", is_typed=False)
        self._next = (place[0], place[1] + 1)
        return Answer(line.text, is_strayed=line.situation is not None)

    def _beginning(self) -> tuple[int, int]:
        first = self._line((0, 0))
        if first is not None and first.situation is not None:
            raise ConfigurationError(
                f"{self._key}={self._path}: none of its episodes begins as this one does; it was recorded in "
                "another scenario, with another team, or by another version"
            )
        return (0, 0)

    def _line(self, place: tuple[int, int]) -> Line | None:
        section, index = place
        lines = self._sections[section] if section < len(self._sections) else []
        return lines[index] if index < len(lines) else None


def read_script(path: Path, key: str = "script") -> list[list[Line]]:
    """The lines of each section that has any. Raises ConfigurationError, which names `key`."""
    try:
        with open(path, "rb") as file:
            content = file.read(MAX_BYTES + 1)
        text = content.decode("utf-8")
    except OSError as error:
        raise ConfigurationError(f"{key}={path}: cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"{key}={path}: is no text in UTF-8 ({error.reason})") from error
    if len(content) > MAX_BYTES:
        raise ConfigurationError(f"{key}={path}: is longer than {MAX_BYTES} bytes: no script")
    sections: list[list[Line]] = [[]]
    for number, line in enumerate(text.split("\n"), start=1):
        if line.startswith("["):
            sections.append([])
        else:
            sections[-1].extend(_read_line(line.rstrip("\r"), f"{key}={path}, line {number}"))
    return [section for section in sections if section]


def _read_line(line: str, where: str) -> Iterator[Line]:
    if not line.strip() or line.startswith("#"):
        return
    if not line.startswith("@"):
        yield Line(line.strip())
        return
    stamp = _STAMP.fullmatch(line)
    if stamp is None:
        raise ConfigurationError(f"{where}: {line[:60]!r}: after @ a step must come, e.g. `@30 stop`")
    yield Line(stamp[3] or "", int(stamp[1]), stamp[2])


class SessionLog:
    """Appends to a script file what a person types. Raises ConfigurationError if it cannot be written."""

    def __init__(self, path: Path, heading: str) -> None:
        self._path = path
        self._heading: Sequence[str] = ("", f"[{heading}]")

    def add(self, line: Line) -> None:
        """Write a line, and flush it; before the first one, the heading of its episode."""
        lines = [*self._heading, str(line)]
        self._heading = ()
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            with open(self._path, "a", encoding="utf-8", errors="replace") as file:
                file.write("\n".join(lines) + "\n")
        except OSError as error:
            raise ConfigurationError(
                f"session={self._path}: cannot be written: {error.strerror or error}"
            ) from error
