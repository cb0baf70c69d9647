"""Texts that are stored once: prompts of an episode are nearly all alike."""

from __future__ import annotations

from collections.abc import Iterable

LONGEST = 20_000
"""Characters of a text that is no prompt; what is longer is cut, and says so."""


class TextStore:
    """Gives every text a number, equal texts the same.

    `lines` are whole texts and lines of prompts; `blocks` are prompts, as stretches of consecutive numbers of
    lines: since lines are numbered as they first come, what prompts have in common is a few long stretches.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.blocks: list[list[int]] = []
        self._line_numbers: dict[str, int] = {}
        self._block_numbers: dict[str, int] = {}

    def line(self, text: object) -> int:
        """The number of a text."""
        return self._line(self.clipped(str(text)))

    def clipped(self, text: str) -> str:
        """A text, cut if it is longer than `LONGEST`."""
        return text if len(text) <= LONGEST else f"{text[:LONGEST]} [cut: {len(text)} characters]"

    def block(self, text: object) -> int:
        """The number of a text of many lines; its stretches are (first, count, first, count, ...)."""
        whole = str(text)
        number = self._block_numbers.get(whole)
        if number is None:
            number = self._block_numbers[whole] = len(self.blocks)
            self.blocks.append(_stretches([self._line(line) for line in whole.split("\n")]))
        return number

    def _line(self, text: str) -> int:
        number = self._line_numbers.setdefault(text, len(self.lines))
        if number == len(self.lines):
            self.lines.append(text)
        return number


def _stretches(numbers: Iterable[int]) -> list[int]:
    found: list[int] = []
    for number in numbers:
        if found and found[-2] + found[-1] == number:
            found[-1] += 1
        else:
            found += [number, 1]
    return found
