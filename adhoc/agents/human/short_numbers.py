"""Short numbers that a person types instead of ids."""

from __future__ import annotations


class ShortNumbers:
    """Numbers from 1 for ids, in the order in which a person first met them; they stay for an episode.

    Objects, receptacles and rooms share one row of numbers, so that a number means one thing.
    """

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}
        self._ids: list[str] = []

    def of(self, name: str) -> int:
        """The number of an id; a new one if it has none yet."""
        if name not in self._numbers:
            self._ids.append(name)
            self._numbers[name] = len(self._ids)
        return self._numbers[name]

    def id(self, text: str) -> str | None:
        """The id that a number stands for, written as digits; None if it stands for none."""
        if not (text.isascii() and text.isdigit() and len(text) < 10):
            return None
        number = int(text)
        return self._ids[number - 1] if 1 <= number <= len(self._ids) else None
