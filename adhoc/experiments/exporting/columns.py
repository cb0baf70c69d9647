"""Records as columns: nested fields get names with dots, and every column has one type."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from adhoc.evaluation.records import REQUIRED, Record

FOLDER = "folder"
"""The first column: the run folder that a record is from, as it was named."""
_WIDEST = 2**63
"""Whole numbers from this size on do not fit into 64 bits and are texts."""


class Kind(str, Enum):
    """The type of a column. Every cell may also be empty."""

    BOOLEAN = "boolean"
    INTEGER = "integer"
    """64 bits, signed."""
    NUMBER = "number"
    """A float of 64 bits."""
    TEXT = "text"


@dataclass(frozen=True)
class Column:
    """One column; `cells` are of its kind, or None."""

    name: str
    kind: Kind
    cells: Sequence[bool | int | float | str | None]


def columns_of(records: Iterable[tuple[str, Record]]) -> list[Column]:
    """The columns of records, each given with its folder: one row a record, in their order.

    The fields of a record stand in its order; fields of fields are named with dots (`llm.calls`), elements of
    lists by their place from 0 (`joined_at.0`), and are sorted by name. What a record lacks is empty, and so
    is null. A column of whole and other numbers is of numbers, one of several types of texts (JSON). Columns
    without any value have the type that the field always has, else text.
    """
    cells: dict[str, list[Any]] = {FOLDER: []}
    fields: dict[str, set[str]] = {FOLDER: {FOLDER}}
    count = 0
    for folder, record in records:
        for field, value in ((FOLDER, folder), *record.items()):
            of_field = fields.setdefault(field, set())
            for name, cell in _flat(field, value):
                of_field.add(name)
                column = cells.setdefault(name, [])
                column.extend([None] * (count - len(column)))
                column.append(cell)
        count += 1
    for column in cells.values():
        column.extend([None] * (count - len(column)))
    return [
        _column(name, cells[name])
        for field, names in fields.items()
        for name in sorted(names)
        if not (name == field and len(names) > 1 and _is_empty(cells[name]))
    ]


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(f"{name}.{key}", inner)
    elif isinstance(value, (list, tuple)):
        for place, inner in enumerate(value):
            yield from _flat(f"{name}.{place}", inner)
    else:
        yield name, value


def _column(name: str, cells: Sequence[Any]) -> Column:
    kinds = {type(cell) for cell in cells if cell is not None}
    if not kinds:
        return Column(name, _usual(name), cells)
    if kinds == {bool}:
        return Column(name, Kind.BOOLEAN, cells)
    if kinds == {int} and all(-_WIDEST <= cell < _WIDEST for cell in cells if cell is not None):
        usual = _usual(name) is Kind.NUMBER
        return _numbers(name, cells) if usual else Column(name, Kind.INTEGER, cells)
    if kinds <= {int, float} and float in kinds:
        return _numbers(name, cells)
    return Column(name, Kind.TEXT, [_text(cell) for cell in cells])


def _numbers(name: str, cells: Sequence[Any]) -> Column:
    return Column(name, Kind.NUMBER, [None if cell is None else float(cell) for cell in cells])


def _text(cell: Any) -> str | None:
    return cell if cell is None or isinstance(cell, str) else json.dumps(cell)


def _usual(name: str) -> Kind:
    kinds = REQUIRED.get(name, str)
    kinds = kinds if isinstance(kinds, tuple) else (kinds,)
    for kind, found in ((bool, Kind.BOOLEAN), (float, Kind.NUMBER), (int, Kind.INTEGER)):
        if kind in kinds:
            return found
    return Kind.TEXT


def _is_empty(cells: Sequence[Any]) -> bool:
    return all(cell is None for cell in cells)
