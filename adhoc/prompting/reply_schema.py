"""JSON schemas of replies, for models that can be held to one.

They keep to what OpenAI, Gemini (by litellm) and llama.cpp's grammars bear: every object is closed and
requires all that it has, unions are `anyOf`, and arrays are bounded but not typed by position: Gemini has no
`prefixItems`, and litellm would make objects of what it types. Where the arguments of a call are of several
kinds, each may be any of them; the reader checks the order. Ids are enumerated once per kind, in `$defs`.

Texts have a greatest length, so that a small model which goes on and on is stopped before its reply is cut
off. Replies are read whatever the length of their texts: OpenAI ignores it where it is not asked to be strict
(see `llm.structured_output`), and llama.cpp refuses 2,000 and more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.core.calls import CallSpec, ParameterKind
from adhoc.prompting.known import LONGEST_TYPE, Known

Schema = dict[str, Any]

ANALYSIS = 1500
"""Characters of a chain of thought: with the rest of a reply, they are fewer than 512 tokens."""
REASON = 300
"""Characters of one sentence."""
LONGEST_NAME = 160
"""Characters of an id that is not enumerated; names in prompts are no longer (`clean.name`)."""
TRUTH: Schema = {"type": "boolean"}
NUMBER: Schema = {"type": "number"}
MAX_ENUM = 250
"""Ids of one kind that are enumerated; where there are more, any string is offered, and the reader checks."""


def text(at_most: int) -> Schema:
    """A text of so many characters."""
    return {"type": "string", "maxLength": at_most}


def closed_object(properties: Mapping[str, Schema]) -> Schema:
    """An object of exactly these properties, in this order."""
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(properties),
        "additionalProperties": False,
    }


def bounded_list(items: Schema, at_least: int, at_most: int) -> Schema:
    """An array of so many items of one schema."""
    return {"type": "array", "items": items, "minItems": at_least, "maxItems": at_most}


def one_of(names: Sequence[str]) -> Schema:
    """One of the names, of which there is at least one."""
    return {"type": "string", "enum": list(names)}


def number_below(count: int) -> Schema:
    """A whole number from 0 to count - 1."""
    return {"type": "integer", "enum": list(range(count))}


def nullable(schema: Schema) -> Schema:
    """What the schema allows, or null."""
    options = schema.get("anyOf", [schema])
    return {"anyOf": [*options, {"type": "null"}]}


def any_call(vocabulary: Sequence[CallSpec], known: Known, with_reason: bool = False) -> Schema:
    """The tagged union of a vocabulary's calls, with the ids in the prompt as arguments.

    A call for which the prompt shows no id is left out, as long as others remain. The arguments refer to
    `id_definitions`, which must stand at the root.
    """
    possible = [
        spec for spec in vocabulary if all(known.ids(it.kind) != () for it in spec.parameters)
    ] or vocabulary
    return {"anyOf": [_call(spec, known, with_reason) for spec in possible]}


def id_definitions(known: Known) -> Schema:
    """The `$defs` of a schema that uses `any_call`."""
    return {
        _definition(kind): one_of(names)
        for kind in ParameterKind
        if (names := known.ids(kind)) and len(names) <= MAX_ENUM
    }


def _call(spec: CallSpec, known: Known, with_reason: bool) -> Schema:
    kinds = dict.fromkeys(parameter.kind for parameter in spec.parameters)
    options = list(map(dict, dict.fromkeys(tuple(_argument(kind, known).items()) for kind in kinds)))
    items = options[0] if len(options) == 1 else {"anyOf": options} if options else text(LONGEST_NAME)
    count = len(spec.parameters)
    properties = {"name": one_of([spec.name]), "args": bounded_list(items, count, count)}
    return closed_object({**properties, "reason": text(REASON)} if with_reason else properties)


def _argument(kind: ParameterKind, known: Known) -> Schema:
    if kind is ParameterKind.NUMBER:
        return NUMBER
    names = known.ids(kind)
    if names is None:
        return text(LONGEST_TYPE)
    is_listed = 0 < len(names) <= MAX_ENUM
    return {"$ref": f"#/$defs/{_definition(kind)}"} if is_listed else text(LONGEST_NAME)


def _definition(kind: ParameterKind) -> str:
    return kind.value.replace(" ", "_")
