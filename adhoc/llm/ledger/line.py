"""An entry as one checked line of a file, and back."""

from __future__ import annotations

import json
from typing import Any

from adhoc.core.errors import LedgerError
from adhoc.core.line_checksum import checked_line, is_intact
from adhoc.llm.ledger.entry import FORMAT, VERSION, Entry, Header, from_json, to_json

DAMAGED = "the checksum ('crc') does not fit the line; the file is damaged"


def encoded(entry: Entry) -> bytes:
    """The line of an entry, with its line break."""
    return checked_line(to_json(entry))


def decoded(line: bytes, where: str) -> Entry:
    """The entry of a line, without its line break. Raises LedgerError, naming `where`, if it is damaged."""
    if not is_intact(line):
        raise LedgerError(f"{where}: {DAMAGED}")
    return from_json(_object(line, where), where)


def decoded_header(line: bytes, where: str) -> Header:
    """The header of a line. Raises LedgerError for damage, another kind of file, and other versions."""
    value = _object(line, where)
    if value.get("format") != FORMAT:
        raise LedgerError(f"{where}: format is {value.get('format')!r}; it should be {FORMAT!r}: no ledger")
    if not is_intact(line):
        raise LedgerError(f"{where}: {DAMAGED}")
    if value.get("version") != VERSION:
        raise LedgerError(
            f"{where}: version is {value.get('version')!r}; this release of the library reads version "
            f"{VERSION}: use the release that wrote it ({value.get('library_version')!r}), or another folder"
        )
    header = from_json(value, where)
    if not isinstance(header, Header):
        raise LedgerError(f"{where}: entry is {value['entry']!r}; a ledger begins with a header")
    return header


def _object(line: bytes, where: str) -> dict[str, Any]:
    try:
        value = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise LedgerError(f"{where}: not a line of a ledger ({error})") from error
    if not isinstance(value, dict):
        raise LedgerError(f"{where}: not a line of a ledger: it is no JSON object")
    return value
