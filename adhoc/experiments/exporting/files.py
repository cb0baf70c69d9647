"""Writing columns to files: CSV by the standard library, Parquet by pyarrow."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from adhoc import __version__
from adhoc.core.errors import MissingDependency
from adhoc.evaluation.records import writing
from adhoc.experiments.exporting.columns import Column, Kind


def write_csv(path: Path, columns: Sequence[Column]) -> None:
    """Write a CSV file (RFC 4180: UTF-8, commas, a header line, quotes where needed).

    Nothing is an empty cell, booleans are `true` and `false`, and numbers have all their digits. Raises
    RecordError if it cannot be written; an old file is replaced whole or not at all.
    """
    with (
        _fresh(path) as part,
        open(part, "w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\r\n")
        writer.writerow(column.name for column in columns)
        writer.writerows(zip(*([_csv_cell(cell) for cell in column.cells] for column in columns)))


def write_parquet(path: Path, columns: Sequence[Column]) -> None:
    """Write a Parquet file whose columns have the types of `columns`, and are all nullable.

    Raises:
        MissingDependency: pyarrow is not installed.
        RecordError: It cannot be written; an old file is replaced whole or not at all.
    """
    try:
        arrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise MissingDependency(
            '--parquet needs the package pyarrow: install it with `pip install "adhoc[parquet]"`, or '
            "write --csv"
        ) from error
    types = {
        Kind.BOOLEAN: arrow.bool_(),
        Kind.INTEGER: arrow.int64(),
        Kind.NUMBER: arrow.float64(),
        Kind.TEXT: arrow.string(),
    }
    fields = [arrow.field(column.name, types[column.kind]) for column in columns]
    schema = arrow.schema(fields, metadata={"adhoc": __version__})
    arrays = [arrow.array(column.cells, types[column.kind]) for column in columns]
    with _fresh(path) as part:
        parquet.write_table(arrow.Table.from_arrays(arrays, schema=schema), str(part))


@contextmanager
def _fresh(path: Path) -> Iterator[Path]:
    """A file beside `path` that takes its place when all is written."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    with writing(path):
        try:
            yield part
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)


def _csv_cell(cell: bool | int | float | str | None) -> str:
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return "true" if cell else "false"
    return cell if isinstance(cell, str) else repr(cell)
