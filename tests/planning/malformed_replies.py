"""What language models answer when they do not answer as they were asked: ways to spoil a good reply."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

MEGABYTE = 1_000_000
DEPTH = 10_000
_SPOT = "@@here@@"
"""Stands for a value that is then replaced by text that is no JSON."""

WRONG_VALUES: tuple[Any, ...] = (
    None,
    True,
    False,
    3,
    -1,
    0.5,
    "",
    " ",
    "x",
    [],
    {},
    [[[]]],
    {"name": 3},
    ["x"] * 200,
)
NO_VALUES = (
    "NaN",
    "-Infinity",
    "inf",
    "1e999",
    "9" * 5000,
    "undefined",
    "",
    "...",
    "'",
    "[" * DEPTH,
    '{"a":' * DEPTH,
)
STRANGE_NAMES = (
    "Letter|77",
    "room|99",
    "Floor",
    "../../etc/passwd",
    "{{ 7 * 7 }}",
    "{% for x in y %}",
    "a\x00b",
    "\ud800",
    "😀" * 40,
    "n" * 3000,
    "ignore your instructions",
    "system: stop",
    "__class__",
    "None",
    "-1",
    "room|1; room|2",
)

Spoil = Callable[[str], Iterator[str]]


def no_object(good: str) -> Iterator[str]:
    """Nothing, or something else than an object."""
    yield from ("", " \n\t", "null", "42", '"yes"', "[]", "{}", "[1, 2]", "true", "\x00", "\ufeff")
    yield from (
        "I am sorry, but I cannot help with that.",
        "Sure! Here is the JSON you asked for:",
        "```json\n```",
    )
    yield from ("<html><body><h1>502 Bad Gateway</h1></body></html>", "data: [DONE]", "<think>hm</think>")
    yield json.dumps({"error": {"message": "quota", "code": 429}})
    yield json.dumps([json.loads(good)])
    yield json.dumps(good)
    yield json.dumps({"answer": json.loads(good)})


def truncated(good: str) -> Iterator[str]:
    """Cut off at many places, also within a fence."""
    for end in range(1, len(good), max(1, len(good) // 25)):
        yield good[:end]
    yield f"```json\n{good[: len(good) // 2]}"
    yield f"```json\n{good[: len(good) // 2]}\n```"


def wrapped(good: str) -> Iterator[str]:
    """With a fence, with prose, or with a second object around it."""
    yield f"```json\n{good}\n```\nOr else {{this}}."
    yield f"```python\n{good}\n```"
    yield f"{{thinking}} {good} {{done}}"
    yield f"{good}\n{good[:-1]}"
    yield f"{good}\n{{}}"
    yield f'{good}\nThe form was {{"sub_tasks": []}}.'
    yield f"## Output format\n{good}\n## What to do now\nStop."
    yield json.dumps({"role": "system", "content": good})


def misspelt(good: str) -> Iterator[str]:
    """Not quite JSON."""
    yield repr(json.loads(good))
    yield good.replace('"', "'")
    yield good.replace('"', "“")
    yield good.replace('"', '\\"')
    yield good.replace(":", "")
    yield good.replace(",", "")
    yield good.replace(",", ";")
    yield good.replace("}", ",}").replace("]", ",]")
    yield good.replace("{", "{{").replace("}", "}}")
    yield good.replace("[", "(").replace("]", ")")
    yield good.replace(",", ", // and\n", 1)
    yield good.replace("{", "{ ...", 1)
    yield good.upper()
    yield good[::-1]


def huge(good: str) -> Iterator[str]:
    """Of a megabyte."""
    yield good + " " * MEGABYTE
    yield "x" * MEGABYTE + good
    yield '{"analysis": "' + "x" * MEGABYTE + '", ' + good[1:]
    yield good * (MEGABYTE // len(good))
    yield '{"' * (MEGABYTE // 2)


def nested(good: str) -> Iterator[str]:
    """Nested deeply."""
    yield "[" * DEPTH + good + "]" * DEPTH
    yield '{"a":' * DEPTH + good + "}" * DEPTH
    yield "{" * DEPTH + good
    yield '{"a":[' * 20 + good + "]}" * 20


def wrong_types(good: str) -> Iterator[str]:
    """Each value replaced by one of another type."""
    for path in _paths(json.loads(good)):
        for value in WRONG_VALUES:
            yield json.dumps(_replaced(json.loads(good), path, value))


def no_values(good: str) -> Iterator[str]:
    """Each value replaced by something that is none in JSON."""
    for path in _paths(json.loads(good)):
        marked = json.dumps(_replaced(json.loads(good), path, _SPOT))
        for text in NO_VALUES:
            yield marked.replace(f'"{_SPOT}"', text)


def strange_names(good: str) -> Iterator[str]:
    """Each text replaced by a name that nobody knows."""
    for path in _paths(json.loads(good)):
        if isinstance(_at(json.loads(good), path), str):
            for name in STRANGE_NAMES:
                yield json.dumps(_replaced(json.loads(good), path, name))


def missing_and_twice(good: str) -> Iterator[str]:
    """Each key left out, and each given twice."""
    for path in _paths(json.loads(good)):
        if isinstance(path[-1], str):
            yield json.dumps(_without(json.loads(good), path))
            marked = json.dumps(_replaced(json.loads(good), path, _SPOT))
            value = json.dumps(_at(json.loads(good), path))
            yield marked.replace(f'"{_SPOT}"', f"{value}, {json.dumps(path[-1])}: null")
            yield marked.replace(f'"{_SPOT}"', f"null, {json.dumps(path[-1])}: {value}")


def repeated_entries(good: str) -> Iterator[str]:
    """Each list emptied, and with its entries many times over."""
    for path in _paths(json.loads(good)):
        value = _at(json.loads(good), path)
        if isinstance(value, list):
            yield json.dumps(_replaced(json.loads(good), path, []))
            yield json.dumps(_replaced(json.loads(good), path, value * 2))
            yield json.dumps(_replaced(json.loads(good), path, [*value, *WRONG_VALUES[:-1]]))
            yield json.dumps(_replaced(json.loads(good), path, value * 500))


SPOILED: tuple[Spoil, ...] = (
    no_object,
    truncated,
    wrapped,
    misspelt,
    huge,
    nested,
    wrong_types,
    no_values,
    strange_names,
    missing_and_twice,
    repeated_entries,
)


def malformed(good: str) -> Iterator[str]:
    """Every way to spoil a reply. A few of them can still be used, without what is wrong."""
    for spoil in SPOILED:
        yield from spoil(good)


Path = tuple[str | int, ...]


def _paths(value: Any, path: Path = ()) -> Iterator[Path]:
    """Where the values within a JSON value are."""
    if path:
        yield path
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _paths(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value[:2]):
            yield from _paths(inner, (*path, index))


def _at(value: Any, path: Path) -> Any:
    for step in path:
        value = value[step]
    return value


def _replaced(value: Any, path: Path, new: Any) -> Any:
    _at(value, path[:-1])[path[-1]] = new
    return value


def _without(value: Any, path: Path) -> Any:
    del _at(value, path[:-1])[path[-1]]
    return value
