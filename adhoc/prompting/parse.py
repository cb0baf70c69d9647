"""Replies of a language model as values, checked against the vocabulary, the prompt and the robot.

Reading is lenient about form (see `prompting.lenient_json`) and strict about content. Every function returns
a `Reading`, whose faults tell what was dropped, and raises `ReplyError` where nothing is left: `empty`,
`truncated` or `unreadable` for the form, `duplicate`, `unknown id` or `illegal` for the content.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.core.calls import Call, CallSpec, TaskBrief
from adhoc.core.errors import ReplyError
from adhoc.core.plans import Candidate, Context, Objection, Prediction, Proposal, Verdict
from adhoc.core.replies import DUPLICATE, ILLEGAL, UNKNOWN_ID, Fault, Reading
from adhoc.prompting.clean import name, one_line
from adhoc.prompting.extract import read_object
from adhoc.prompting.known import Known
from adhoc.prompting.read_call import Refusal, read_call, read_number, shown

_REASON_CHARACTERS = 500
_MAX_ENTRIES = 100
"""Entries of a list that are looked at."""
_TRUTH = {"true": True, "yes": True, "false": False, "no": False}


def read_sub_tasks(text: str, brief: TaskBrief, known: Known, count: int, refusal: Refusal | None) -> Reading:
    """The proposed sub-tasks as a tuple of candidates in the model's order, at most `count`.

    Duplicates and what is not allowed are dropped, each with a fault; what is too many, without.
    """
    candidates: dict[Call, Candidate] = {}
    faults: list[Fault] = []
    for entry in _list(read_object(text), "sub_tasks"):
        try:
            call = read_call(entry, brief.sub_tasks, known, "sub-task", refusal)
        except ReplyError as error:
            faults.append(Fault(error.outcome, str(error)))
            continue
        if call in candidates:
            faults.append(Fault(DUPLICATE, f"{call} is proposed twice"))
        candidates.setdefault(call, Candidate(call, _reason(entry)))
    if not candidates:
        raise _nothing_left(faults, "the reply proposes no sub-task")
    return Reading(tuple(candidates.values())[:count], tuple(faults))


def read_ranking(text: str, count: int) -> Reading:
    """A permutation of range(count), best first; candidates that the model left out follow in their order."""
    given = [_index(entry, count) for entry in _list(read_object(text), "ranking")]
    if len(set(given)) != len(given):
        raise ReplyError(f"ranking {given} must name each of 0 to {count - 1} once", DUPLICATE)
    if not given:
        raise ReplyError("the ranking is empty", ILLEGAL)
    return Reading((*given, *(index for index in range(count) if index not in given)))


def read_scores(text: str, count: int) -> Reading:
    """One score per candidate as a tuple, None where the model gave none."""
    scores: list[float | None] = [None] * count
    for entry in _list(read_object(text), "scores"):
        if not isinstance(entry, Mapping):
            raise ReplyError(f'a score looks like {{"index": 0, "score": 5}}, not {shown(entry)}', ILLEGAL)
        index = _index(entry.get("index"), count)
        if scores[index] is not None:
            raise ReplyError(f"sub-task {index} is scored twice", DUPLICATE)
        scores[index] = read_number(entry.get("score"), "score")
    if all(score is None for score in scores):
        raise ReplyError("the reply scores no sub-task", ILLEGAL)
    return Reading(tuple(scores))


def read_verdict(text: str) -> Reading:
    """Whether the chosen sub-task is feasible, and why."""
    reply = read_object(text)
    return Reading(Verdict(_truth(reply, "feasible"), _reason(reply)))


def read_sub_skill(text: str, brief: TaskBrief, known: Known, refusal: Refusal | None) -> Reading:
    """The next sub-skill as a call."""
    reply = read_object(text)
    if "sub_skill" not in reply:
        raise ReplyError(f'the reply has no "sub_skill", only {shown(sorted(reply))}', ILLEGAL)
    return Reading(read_call(reply["sub_skill"], brief.sub_skills, known, "sub-skill", refusal))


def read_predictions(text: str, brief: TaskBrief, known: Known) -> Reading:
    """What the teammates will do, as a tuple of predictions.

    Strangers, second predictions for one teammate, and calls that are not of the vocabulary are dropped,
    each with a fault. A call that is null or missing is unknown. Teammates' abilities are not checked.
    """
    predictions: dict[str, Prediction] = {}
    faults: list[Fault] = []
    for entry in _list(read_object(text), "predictions"):
        named = entry.get("teammate") if isinstance(entry, Mapping) else None
        teammate = known.find_teammate(named.strip()) if isinstance(named, str) else None
        if teammate is None:
            faults.append(Fault(UNKNOWN_ID, f"{shown(entry)} predicts for no known teammate"))
        elif teammate in predictions:
            faults.append(Fault(DUPLICATE, f"{teammate} is predicted twice"))
        else:
            sub_task = _call_or_none(entry.get("sub_task"), brief.sub_tasks, known, "sub-task", faults)
            sub_skill = _call_or_none(entry.get("sub_skill"), brief.sub_skills, known, "sub-skill", faults)
            predictions[teammate] = Prediction(teammate, sub_task, sub_skill)
    if not predictions and known.teammates:
        raise _nothing_left(faults, f"the reply predicts nothing for any of {shown(known.teammates)}")
    return Reading(tuple(predictions.values()), tuple(faults))


def read_proposal(
    text: str, context: Context, known: Known, plans: Mapping[str, Call], refusal: Refusal | None
) -> Reading:
    """A robot's own sub-task and its objections to plans of others, as a `Proposal`.

    Objections to what nobody planned, and second ones to one plan, are dropped, each with a fault. Whoever
    says that it agrees objects to nothing.
    """
    reply = read_object(text)
    entry = reply.get("sub_task")
    call = read_call(entry, context.task.sub_tasks, known, "sub-task", refusal)
    objections: dict[str, Objection] = {}
    faults: list[Fault] = []
    planners = {name(robot): robot for robot in plans}
    disagrees = _truth(reply, "agree") is False
    for it in _list(reply, "objections") if disagrees and "objections" in reply else ():
        named = it.get("teammate") if isinstance(it, Mapping) else None
        planner = planners.get(named.strip()) if isinstance(named, str) else None
        if planner is None:
            faults.append(Fault(UNKNOWN_ID, f"{shown(it)} objects to no plan of a teammate"))
        elif planner in objections:
            faults.append(Fault(DUPLICATE, f"the plan of {planner} is objected to twice"))
        else:
            objections[planner] = Objection(context.me, planner, plans[planner], _reason(it))
    return Reading(Proposal(call, _reason(entry), tuple(objections.values())), tuple(faults))


def _truth(reply: Mapping[str, Any], field: str) -> bool:
    value = reply.get(field)
    if isinstance(value, str):
        value = _TRUTH.get(value.strip().lower())
    if not isinstance(value, bool):
        raise ReplyError(f'"{field}" must be true or false, not {shown(reply.get(field))}', ILLEGAL)
    return value


def _call_or_none(
    entry: Any, vocabulary: Sequence[CallSpec], known: Known, what: str, faults: list[Fault]
) -> Call | None:
    try:
        return None if entry is None else read_call(entry, vocabulary, known, what)
    except ReplyError as error:
        faults.append(Fault(error.outcome, str(error)))
        return None


def _nothing_left(faults: Sequence[Fault], otherwise: str) -> ReplyError:
    """The outcome that all entries share, else `illegal`."""
    outcomes = {fault.outcome for fault in faults}
    outcome = outcomes.pop() if len(outcomes) == 1 else ILLEGAL
    return ReplyError("; ".join(dict.fromkeys(fault.detail for fault in faults)) or otherwise, outcome)


def _list(reply: Mapping[str, Any], field: str) -> list[Any]:
    value = reply.get(field)
    if isinstance(value, Mapping):
        value = [value]
    if not isinstance(value, list):
        raise ReplyError(f'the reply needs a list "{field}", not {shown(value)}', ILLEGAL)
    if len(value) > _MAX_ENTRIES:
        raise ReplyError(f'"{field}" has {len(value)} entries; give at most {_MAX_ENTRIES}', ILLEGAL)
    return value


def _index(value: Any, count: int) -> int:
    index = read_number(value, "the number of a sub-task")
    if index != int(index) or not 0 <= index < count:
        raise ReplyError(
            f"there is no sub-task {shown(value)}; they are numbered 0 to {count - 1}", UNKNOWN_ID
        )
    return int(index)


def _reason(entry: Any) -> str:
    if not isinstance(entry, Mapping):
        return ""
    reason = entry.get("reason") or entry.get("analysis") or ""
    return one_line(str(reason), _REASON_CHARACTERS)
