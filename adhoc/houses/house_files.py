"""House files: one JSON document (`.json`) or one per line (`.jsonl`), each also compressed (`.gz`)."""

from __future__ import annotations

import gzip
import json
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, NoReturn

from adhoc.core.errors import HouseError

EXTENSIONS = (".json", ".json.gz", ".jsonl", ".jsonl.gz")


@dataclass(frozen=True)
class Document:
    """One document of a house file, not yet parsed."""

    name: str
    """The file's name without extension; for lines, with `:` and the index of the house, from 0."""
    source: str
    """File and line, for error texts."""
    text: str


def documents(path: str | Path) -> Iterator[Document]:
    """The documents of a house file, read lazily; empty lines are skipped.

    Raises HouseError if the file is missing, has another extension, is damaged, or holds no document.
    """
    path = Path(path)
    extension = next((e for e in EXTENSIONS if path.name.endswith(e)), None)
    if extension is None:
        raise HouseError(f"{path}: a house file ends with one of {', '.join(EXTENSIONS)}")
    name = path.name.removesuffix(extension)
    found = 0
    try:
        with _open(path) as file:
            if extension.startswith(".jsonl"):
                for number, line in enumerate(file, start=1):
                    if line.strip():
                        yield Document(f"{name}:{found}", f"{path} line {number}", line)
                        found += 1
            elif (text := file.read()).strip():
                yield Document(name, str(path), text)
                found = 1
    except (OSError, EOFError, zlib.error, UnicodeDecodeError) as error:
        raise HouseError(f"{path}: cannot be read as a house file: {error}") from error
    if not found:
        raise HouseError(f"{path}: the file is empty; it should hold at least one house")


def decode(document: Document) -> object:
    """The JSON value of a document. Raises HouseError if it is no valid JSON."""
    try:
        return json.loads(document.text, parse_constant=_refuse_constant)
    except RecursionError:
        raise HouseError(f"{document.source}: the JSON is nested too deeply") from None
    except ValueError as error:
        raise HouseError(f"{document.source}: not valid JSON, or cut off: {error}") from error


def _open(path: Path) -> IO[str]:
    if path.name.endswith(".gz"):
        return gzip.open(path, "rt", encoding="utf-8")
    return path.open(encoding="utf-8")


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")
