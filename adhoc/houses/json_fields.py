"""Typed access to foreign JSON: every wrong field becomes one HouseError with its path, value and remedy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from adhoc.core.errors import AssetError, HouseError
from adhoc.houses.facts import AssetFacts, asset

LARGEST = 1000.0
"""No coordinate of a house is larger, in metres; degrees and openness are far below it too."""


@dataclass(frozen=True)
class Fields:
    """A JSON object, with `source` (file and line) and `path` inside the document for error texts.

    All methods raise HouseError if the field is missing or of the wrong kind.
    """

    value: dict[str, Any]
    source: str
    path: str = ""

    @classmethod
    def of(cls, value: object, source: str, path: str = "") -> Fields:
        """The fields of `value`, which must be a JSON object."""
        if not isinstance(value, dict):
            raise HouseError(f"{source}: {path or 'the document'} is {shown(value)}; it should be an object")
        return cls(value, source, path)

    def has(self, name: str) -> bool:
        """Whether the field is there and not null."""
        return self.value.get(name) is not None

    def text(self, name: str) -> str:
        """A string that is not empty."""
        value = self._get(name)
        if not isinstance(value, str) or not value:
            raise self.error(name, "a string that is not empty")
        if not value.isprintable():
            raise self.error(name, "a string of printable characters")
        return value

    def number(self, name: str) -> float:
        """A finite number of a sensible size."""
        value = self._get(name)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.error(name, "a number")
        if not -LARGEST <= value <= LARGEST:
            raise self.error(name, f"a number between -{LARGEST:g} and {LARGEST:g}")
        return float(value)

    def flag(self, name: str) -> bool:
        """True or false; false if the field is not there."""
        value = self.value.get(name, False)
        if not isinstance(value, bool):
            raise self.error(name, "true or false")
        return value

    def fields(self, name: str) -> Fields:
        """A nested JSON object."""
        return Fields.of(self._get(name), self.source, self._path_of(name))

    def items(self, name: str) -> Iterator[Fields]:
        """The JSON objects of a list, in order."""
        value = self._get(name)
        if not isinstance(value, list):
            raise self.error(name, "a list")
        for index, item in enumerate(value):
            yield Fields.of(item, self.source, f"{self._path_of(name)}[{index}]")

    def asset(self, name: str) -> AssetFacts:
        """The facts of the asset that a field names. Raises AssetError if it is not in the fact tables."""
        try:
            return asset(self.text(name))
        except AssetError as error:
            raise AssetError(f"{self.source}: {self._path_of(name)}: {error}") from None

    def point(self) -> tuple[float, float, float]:
        """This object as a point {x, y, z} of the Unity frame, in the world frame (z up)."""
        return self.number("x"), self.number("z"), self.number("y")

    def error(self, name: str, wanted: str) -> HouseError:
        """The error that says that the field should be `wanted`."""
        value = shown(self.value[name]) if name in self.value else "missing"
        return HouseError(f"{self.source}: {self._path_of(name)} is {value}; it should be {wanted}")

    def _get(self, name: str) -> object:
        if name not in self.value:
            raise HouseError(f"{self.source}: {self._path_of(name)} is missing")
        return self.value[name]

    def _path_of(self, name: str) -> str:
        return f"{self.path}.{name}" if self.path else name


def shown(value: object) -> str:
    """A JSON value, shortened for an error text."""
    if isinstance(value, (dict, list)):
        kind = "an object" if isinstance(value, dict) else "a list"
        return f"{kind} of {len(value)}"
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 200:
        return "an integer of more than 200 bits"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
