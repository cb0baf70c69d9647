"""Replies of a language model as values, checked against the task's vocabulary and what the robot knows.

Reading is lenient about form (see `prompting.extract`) and strict about content. Every function raises
`ReplyError`: `empty`, `truncated` or `unreadable` for the form, `illegal` for the content.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from adhoc.core.calls import Argument, Call, CallSpec, ParameterKind
from adhoc.core.errors import ReplyError
from adhoc.core.plans import Candidate, Context, Prediction, Verdict
from adhoc.prompting.clean import one_line
from adhoc.prompting.extract import read_object

FLOOR = "Floor"
"""The receptacle and receptacle type of what lies on the floor; always known."""
_REASON_CHARACTERS = 500
_TRUTH = {"true": True, "yes": True, "false": False, "no": False}


def read_sub_tasks(text: str, context: Context, count: int) -> tuple[Candidate, ...]:
    """The proposed sub-tasks, at most `count`, without duplicates, in the model's order.

    Illegal ones among legal ones are dropped; ReplyError (`illegal`) if none is legal.
    """
    entries = _list(read_object(text), "sub_tasks")
    known = _Known(context)
    candidates: dict[Call, Candidate] = {}
    faults: list[str] = []
    for entry in entries:
        try:
            call = known.call(entry, context.task.sub_tasks, "sub-task")
        except ReplyError as error:
            faults.append(str(error))
            continue
        candidates.setdefault(call, Candidate(call, _reason(entry)))
    if not candidates:
        raise ReplyError("; ".join(faults) or "the reply proposes no sub-task", "illegal")
    return tuple(candidates.values())[:count]


def read_ranking(text: str, count: int) -> tuple[int, ...]:
    """A permutation of range(count), best first.

    Candidates that the model left out follow in their old order; ReplyError (`illegal`) on an index that
    does not exist, on one given twice, or if none is given.
    """
    given = [_index(entry, count) for entry in _list(read_object(text), "ranking")]
    if not given or len(set(given)) != len(given):
        raise ReplyError(f"ranking {given} must name each of 0 to {count - 1} once", "illegal")
    return (*given, *(index for index in range(count) if index not in given))


def read_scores(text: str, count: int) -> tuple[float | None, ...]:
    """One score per candidate, None where the model gave none; ReplyError (`illegal`) if there is none."""
    scores: list[float | None] = [None] * count
    for entry in _list(read_object(text), "scores"):
        if not isinstance(entry, Mapping):
            raise ReplyError(f'score {entry!r} must look like {{"index": 0, "score": 5}}', "illegal")
        scores[_index(entry.get("index"), count)] = _number(entry.get("score"), "score")
    if all(score is None for score in scores):
        raise ReplyError("the reply scores no candidate", "illegal")
    return tuple(scores)


def read_verdict(text: str) -> Verdict:
    """Whether the chosen sub-task is feasible, and why."""
    reply = read_object(text)
    feasible = reply.get("feasible")
    if isinstance(feasible, str):
        feasible = _TRUTH.get(feasible.strip().lower())
    if not isinstance(feasible, bool):
        raise ReplyError(f'"feasible" must be true or false, not {reply.get("feasible")!r}', "illegal")
    return Verdict(feasible, _reason(reply))


def read_sub_skill(text: str, context: Context) -> Call:
    """The next sub-skill, a legal call of the task's sub-skills."""
    reply = read_object(text)
    if "sub_skill" not in reply:
        raise ReplyError(f'the reply has no "sub_skill", only {sorted(reply)}', "illegal")
    return _Known(context).call(reply["sub_skill"], context.task.sub_skills, "sub-skill")


def read_predictions(text: str, context: Context) -> tuple[Prediction, ...]:
    """What the teammates will do, for those that are known; what is not legal is left out."""
    known = _Known(context)
    teammates = {view.name for view in context.teammates}
    predictions = []
    for entry in _list(read_object(text), "predictions"):
        if isinstance(entry, Mapping) and entry.get("teammate") in teammates:
            sub_task = known.call_or_none(entry.get("sub_task"), context.task.sub_tasks, "sub-task")
            sub_skill = known.call_or_none(entry.get("sub_skill"), context.task.sub_skills, "sub-skill")
            predictions.append(Prediction(str(entry["teammate"]), sub_task, sub_skill))
    if teammates and not predictions:
        raise ReplyError(f"the reply predicts nothing for any of {sorted(teammates)}", "illegal")
    return tuple(predictions)


class _Known:
    """What arguments may name: the ids and types of one context."""

    def __init__(self, context: Context) -> None:
        held = [context.holding] if context.holding else []
        objects = [record.id for record in context.objects]
        receptacles = [record.id for record in context.objects if record.is_receptacle]
        categories = {record.category for record in context.objects} | {FLOOR}
        room_types = {room.room_type for room in context.rooms if room.room_type}
        self._names: dict[ParameterKind, Callable[[str], str | None]] = {
            ParameterKind.OBJECT: _matcher([*objects, *held]),
            ParameterKind.RECEPTACLE: _matcher([*receptacles, FLOOR]),
            ParameterKind.ROOM: _matcher([room.id for room in context.rooms]),
            ParameterKind.RECEPTACLE_TYPE: _type_matcher(categories),
            ParameterKind.ROOM_TYPE: _type_matcher(room_types),
        }

    def call(self, entry: Any, vocabulary: Sequence[CallSpec], what: str) -> Call:
        """The call that a reply's entry describes; ReplyError (`illegal`) if it is none of the vocabulary."""
        name, args = _name_and_args(entry, what)
        spec = next((it for it in vocabulary if it.name.casefold() == name.casefold()), None)
        if spec is None:
            allowed = ", ".join(it.signature for it in vocabulary)
            raise ReplyError(f"{name!r} is no {what}; there are: {allowed}", "illegal")
        if isinstance(args, Mapping):
            args = [args[parameter.name] for parameter in spec.parameters if parameter.name in args]
        if len(args) != len(spec.parameters):
            raise ReplyError(
                f"{spec.signature} takes {len(spec.parameters)} arguments, not {len(args)}: {args}", "illegal"
            )
        return Call(
            spec.name,
            tuple(
                self._argument(value, it.kind, f"<{it.name}> of {spec.name}")
                for value, it in zip(args, spec.parameters)
            ),
        )

    def call_or_none(self, entry: Any, vocabulary: Sequence[CallSpec], what: str) -> Call | None:
        try:
            return self.call(entry, vocabulary, what)
        except ReplyError:
            return None

    def _argument(self, value: Any, kind: ParameterKind, where: str) -> Argument:
        if kind is ParameterKind.NUMBER:
            return _number(value, where)
        if not isinstance(value, str) or not value.strip():
            raise ReplyError(f"{where} must be a {kind.value}, not {value!r}", "illegal")
        found = self._names[kind](value.strip())
        if found is None:
            raise ReplyError(f"{where}: {value!r} is no known {kind.value}", "illegal")
        return found


def _matcher(names: Iterable[str]) -> Callable[[str], str | None]:
    """Finds a name exactly, or else by its letters where only one name has them, whatever their case."""
    exact = set(names)
    folded: dict[str, str | None] = {}
    for name in exact:
        folded[name.casefold()] = None if name.casefold() in folded else name
    return lambda wanted: wanted if wanted in exact else folded.get(wanted.casefold())


def _type_matcher(types: Iterable[str]) -> Callable[[str], str | None]:
    """Finds a type among the known ones whatever its case and spacing, or takes it as a new one.

    A robot may well look for a type of place that it has not seen yet, so an unknown type is legal.
    """
    folded = {_squeeze(name): name for name in types}

    def find(wanted: str) -> str | None:
        known = folded.get(_squeeze(wanted))
        if known is not None:
            return known
        words = wanted.replace("_", " ").split()
        named = "".join(word[:1].upper() + word[1:] for word in words)
        return named if named.isalnum() and len(named) <= 40 else None

    return find


def _squeeze(name: str) -> str:
    return name.replace(" ", "").replace("_", "").casefold()


def _name_and_args(entry: Any, what: str) -> tuple[str, Any]:
    if isinstance(entry, str) and entry.split():
        name, *args = entry.split()
        return name, args
    if not isinstance(entry, Mapping) or not isinstance(entry.get("name"), str):
        raise ReplyError(f'a {what} must look like {{"name": ..., "args": [...]}}, not {entry!r}', "illegal")
    args = entry.get("args") or []
    if not isinstance(args, (list, Mapping)):
        args = [args]
    return entry["name"].strip(), args


def _list(reply: Mapping[str, Any], field: str) -> list[Any]:
    value = reply.get(field)
    if isinstance(value, Mapping):
        value = [value]
    if not isinstance(value, list):
        raise ReplyError(f'the reply needs a list "{field}", not {value!r}', "illegal")
    return value


def _index(value: Any, count: int) -> int:
    index = _number(value, "candidate number")
    if index != int(index) or not 0 <= index < count:
        raise ReplyError(f"there is no candidate {value!r}; they are numbered 0 to {count - 1}", "illegal")
    return int(index)


def _number(value: Any, where: str) -> float:
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            value = None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ReplyError(f"{where} must be a finite number, not {value!r}", "illegal")
    return float(value)


def _reason(entry: Any) -> str:
    if not isinstance(entry, Mapping):
        return ""
    reason = entry.get("reason") or entry.get("analysis") or ""
    return one_line(str(reason), _REASON_CHARACTERS)
