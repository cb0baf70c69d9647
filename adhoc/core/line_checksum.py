"""JSON lines that carry the checksum of their own bytes."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from typing import Any

_MARK = b',"crc":"'
_TAIL = len(_MARK) + 8 + len(b'"}')


def canonical(value: Mapping[str, Any]) -> bytes:
    """A JSON object in the one way in which this library writes it on a line: ASCII, fields in their order.

    Raises ValueError for what JSON cannot say, such as NaN.
    """
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()


def checked_line(value: Mapping[str, Any]) -> bytes:
    """A JSON object, not empty, as a line that ends with `"crc"`: the CRC-32 of the bytes before it as eight
    hexadecimal digits."""
    body = canonical(value)[:-1]
    return body + _MARK + f"{zlib.crc32(body):08x}".encode() + b'"}\n'


def is_intact(line: bytes) -> bool:
    """Whether a line, without its line break, has the checksum that it says it has."""
    body, tail = line[:-_TAIL], line[-_TAIL:]
    return tail == _MARK + f"{zlib.crc32(body):08x}".encode() + b'"}'
