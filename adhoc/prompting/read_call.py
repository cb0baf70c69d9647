"""A sub-task or sub-skill as a model writes it, as a checked `Call`."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from adhoc.core.calls import Argument, Call, CallSpec, Parameter, ParameterKind
from adhoc.core.errors import ReplyError
from adhoc.core.replies import ILLEGAL, UNKNOWN_ID
from adhoc.prompting.clean import one_line
from adhoc.prompting.known import Known

Refusal = Callable[[Call], str | None]
"""Why this robot may not do a call, as a sentence; None if it may."""

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
_SHOWN = 120


def read_call(
    entry: Any, vocabulary: Sequence[CallSpec], known: Known, what: str, refusal: Refusal | None = None
) -> Call:
    """The call that a reply's entry describes.

    `{"name": ..., "args": [...]}` is asked for; arguments by name and `"Name argument ..."` are understood.

    Args:
        entry: A JSON value.
        vocabulary: What may be called.
        known: What arguments may name.
        what: `sub-task` or `sub-skill`, for error texts.
        refusal: The task's check for this robot; None: whatever the vocabulary has is allowed.

    Raises:
        ReplyError: `unknown id` if an argument names nothing in the prompt, else `illegal`.
    """
    name, args = _name_and_args(entry, what)
    spec = next((it for it in vocabulary if it.name.casefold() == name.casefold()), None)
    if spec is None:
        allowed = ", ".join(it.signature for it in vocabulary)
        raise ReplyError(f"{shown(name)} is no {what}; there are: {allowed}", ILLEGAL)
    if isinstance(args, Mapping):
        args = [args[parameter.name] for parameter in spec.parameters if parameter.name in args]
    if len(args) != len(spec.parameters):
        raise ReplyError(
            f"{spec.signature} takes {len(spec.parameters)} arguments, not {len(args)}: {shown(args)}",
            ILLEGAL,
        )
    arguments = (
        _argument(value, parameter, spec.name, known) for value, parameter in zip(args, spec.parameters)
    )
    call = Call(spec.name, tuple(arguments))
    reason = None if refusal is None else refusal(call)
    if reason is not None:
        raise ReplyError(f"{call}: {reason}", ILLEGAL)
    return call


def read_number(value: Any, where: str) -> float:
    """A finite number, also one written as text; ReplyError (`illegal`) for all else, also truth values."""
    if isinstance(value, str) and _NUMBER.fullmatch(value.strip()):
        value = float(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ReplyError(f"{where} must be a finite number, not {shown(value)}", ILLEGAL)
    return float(value)


def shown(value: Any) -> str:
    """A value of a reply as error texts quote it: on one line, of bounded length."""
    return one_line(repr(value), _SHOWN)


def _argument(value: Any, parameter: Parameter, of: str, known: Known) -> Argument:
    where, kind = f"<{parameter.name}> of {of}", parameter.kind
    if kind is ParameterKind.NUMBER:
        return read_number(value, where)
    if not isinstance(value, str) or not value.strip():
        raise ReplyError(f"{where} must be the name of a {kind.value}, not {shown(value)}", ILLEGAL)
    found = known.find(kind, value.strip())
    if found is None:
        raise ReplyError(f"{where}: {shown(value)} is no {kind.value} of those listed", UNKNOWN_ID)
    return found


def _name_and_args(entry: Any, what: str) -> tuple[str, Any]:
    if isinstance(entry, str) and entry.split():
        return entry.split()[0], entry.split()[1:]
    if not isinstance(entry, Mapping) or not isinstance(entry.get("name"), str):
        raise ReplyError(
            f'a {what} must look like {{"name": ..., "args": [...]}}, not {shown(entry)}', ILLEGAL
        )
    args = entry.get("args")
    if not isinstance(args, (list, Mapping)):
        args = [] if args is None else [args]
    return entry["name"].strip(), args
