"""What stands in a ledger: a header, texts, calls, and how each call ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from adhoc.core.errors import LedgerError

FORMAT = "adhoc ledger"
VERSION = 1
SHOWN = 60


@dataclass(frozen=True)
class Header:
    """The first line of every file. `model` and `settings` are part of every key in it."""

    format: str
    version: int
    library_version: str
    model: str
    """The name of the model that was asked."""
    window: int | None
    """Its longest prompt in tokens."""
    settings: Mapping[str, Any]
    """How it was set up, where that decides answers."""
    time: str
    """When the file was begun; this and all times are of UTC, in the form of ISO 8601."""


@dataclass(frozen=True)
class Text:
    """A text that calls refer to, once in a file: the content of a message, or a JSON schema."""

    sha256: str
    content: str
    redacted: bool = False
    """Whether something was taken out, so that the content no longer has this hash."""


@dataclass(frozen=True)
class Call:
    """A call that is about to be made. Without a later entry of the same key it was in flight when the
    process ended, and may have been paid."""

    key: str
    stage: str
    agent: str
    episode: str
    """Who asked first; equal requests of other episodes are answered from here."""
    template: str
    sample: int
    repeat: int
    """How many equal requests the robot had made in the episode before."""
    model: str
    temperature: float | None
    max_tokens: int
    seed: int | None
    schema: str | None
    """The hash of the reply's JSON schema; its text is in the file."""
    messages: tuple[tuple[str, str], ...]
    """Role and hash of every message; the texts are in the file."""
    time: str


@dataclass(frozen=True)
class Answer:
    """The answer to a call. One of no use was paid, too: it is a ReplyError, which replays raise again."""

    key: str
    model: str
    """Empty if the ReplyError came without an answer; then what it used is not known."""
    prompt_tokens: int
    completion_tokens: int
    cost_usd: float
    finish_reason: str
    latency_s: float
    text: str
    raw: Mapping[str, Any] | None
    """What the provider sent, without headers."""
    outcome: str | None
    """`ReplyError.outcome` of an answer of no use, else null."""
    problem: str | None
    """The text of that error, else null."""
    time: str


@dataclass(frozen=True)
class Failure:
    """A call that was not answered; it is made again when it is asked for again."""

    key: str
    error: str
    """The error's type, e.g. `ModelBusy`."""
    message: str
    time: str


Entry = Header | Text | Call | Answer | Failure

KINDS: Mapping[str, type[Entry]] = {
    "header": Header,
    "text": Text,
    "call": Call,
    "answer": Answer,
    "failure": Failure,
}
_NAMES = {kind: name for name, kind in KINDS.items()}
_FIELDS = {kind: [(it.name, str(it.type)) for it in fields(kind)] for kind in _NAMES}
_FORMS: Mapping[str, tuple[tuple[type, ...], str]] = {
    "str": ((str,), "a text"),
    "str | None": ((str, type(None)), "a text or null"),
    "int": ((int,), "a whole number"),
    "int | None": ((int, type(None)), "a whole number or null"),
    "float": ((int, float), "a number"),
    "float | None": ((int, float, type(None)), "a number or null"),
    "bool": ((bool,), "true or false"),
    "Mapping[str, Any]": ((dict,), "an object"),
    "Mapping[str, Any] | None": ((dict, type(None)), "an object or null"),
    "tuple[tuple[str, str], ...]": ((list,), "a list of pairs of texts"),
}
"""By the annotation of a field: what JSON may hold there, and how errors call it."""


def to_json(entry: Entry) -> dict[str, Any]:
    """The JSON object of an entry; its first fields are `entry`, the kind, and the key if it has one."""
    return {"entry": _NAMES[type(entry)], **{name: getattr(entry, name) for name, _ in _FIELDS[type(entry)]}}


def from_json(value: Mapping[str, Any], where: str) -> Entry:
    """The entry of a JSON object. Raises LedgerError, naming place and field, if it is none."""
    kind = KINDS.get(str(value.get("entry")))
    if kind is None:
        found_kind, known = _shown(value.get("entry")), ", ".join(KINDS)
        raise LedgerError(f"{where}: entry is {found_kind}; it should be one of {known}")
    found: dict[str, Any] = {}
    for name, annotation in _FIELDS[kind]:
        if name not in value:
            raise LedgerError(f"{where}: field {name!r} is missing")
        found[name] = _checked(value[name], annotation, name, where)
    extra = sorted(value.keys() - found.keys() - {"entry", "crc"})
    if extra:
        raise LedgerError(f"{where}: there is no field {extra[0]!r} in an entry of this kind")
    return kind(**found)


def _checked(value: Any, annotation: str, name: str, where: str) -> Any:
    kinds, wanted = _FORMS[annotation]
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        raise LedgerError(f"{where}: {name} is {_shown(value)}; it should be {wanted}")
    if not isinstance(value, list):
        return value
    pairs = tuple(tuple(pair) if isinstance(pair, list) else () for pair in value)
    if not all(len(pair) == 2 and all(isinstance(part, str) for part in pair) for pair in pairs):
        raise LedgerError(f"{where}: {name} is {_shown(value)}; it should be {wanted}")
    return pairs


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
