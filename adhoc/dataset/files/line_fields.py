"""What `houses.json_fields` has no word for: whole numbers, bounds, points, and no field too many."""

from __future__ import annotations

import re
from collections.abc import Collection

from adhoc.core.errors import HouseError
from adhoc.core.values import Point
from adhoc.houses.json_fields import LARGEST, Fields

MOST_SEED = 2**63 - 1
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")


def whole(fields: Fields, name: str, low: int, high: int) -> int:
    """A whole number within bounds. This and all others here raise HouseError, as `Fields` does."""
    value = fields.value.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise fields.error(name, f"a whole number from {low} to {high}")
    return value


def name_of(fields: Fields, name: str) -> str:
    """A name that is fit for a file: letters, digits, `_`, `.` and `-`."""
    value = fields.text(name)
    if not _NAME.fullmatch(value):
        raise fields.error(name, "a name of letters, digits, '_', '.' and '-'")
    return value


def between(fields: Fields, name: str, bounds: tuple[float, float]) -> float:
    """A number within bounds."""
    value = fields.number(name)
    if not bounds[0] <= value <= bounds[1]:
        raise fields.error(name, f"a number from {bounds[0]:g} to {bounds[1]:g}")
    return value


def pair(fields: Fields, name: str) -> tuple[float, float]:
    """Two numbers, the lower one first."""
    first, second = numbers(fields, name, 2)
    if first > second:
        raise fields.error(name, "a lowest and a highest number")
    return first, second


def whole_pair(fields: Fields, name: str) -> tuple[int, int]:
    """Two whole numbers, the lower one first."""
    first, second = pair(fields, name)
    if first != int(first) or second != int(second):
        raise fields.error(name, "two whole numbers")
    return int(first), int(second)


def point(fields: Fields, name: str) -> Point:
    """Three numbers: x, y and z in metres."""
    x, y, z = numbers(fields, name, 3)
    return x, y, z


def numbers(fields: Fields, name: str, count: int | None = None) -> tuple[float, ...]:
    """A list of `count` finite numbers, or of any number of them, at least one."""
    value = fields.value.get(name)
    wanted = "a list of numbers" if count is None else f"a list of {count} numbers"
    if not isinstance(value, list) or not value or (count is not None and len(value) != count):
        raise fields.error(name, wanted)
    for number in value:
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not abs(number) <= LARGEST:
            raise fields.error(name, f"{wanted} between -{LARGEST:g} and {LARGEST:g}")
    return tuple(float(number) for number in value)


def texts(fields: Fields, name: str) -> tuple[str, ...]:
    """A list of strings, none of them twice."""
    value = fields.value.get(name)
    if not isinstance(value, list) or not all(isinstance(text, str) and text for text in value):
        raise fields.error(name, "a list of names")
    if len(set(value)) != len(value):
        raise fields.error(name, "a list of names that are all different")
    return tuple(value)


def only(fields: Fields, names: Collection[str]) -> None:
    """Raise HouseError if there is a field of another name, as a later version might have."""
    for name in fields.value:
        if name not in names:
            place = f"{fields.path}.{name}" if fields.path else name
            raise HouseError(
                f"{fields.source}: {place}: there is no such field; there are {', '.join(names)}"
            )
