"""The form of the reply that each stage of planning asks for: its schema, and its reader.

The texts `analysis` and `reason` are part of a form where the prompt's system message names them: templates
without reasoning ask for none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from adhoc.core.calls import Call
from adhoc.core.chat import ChatMessage
from adhoc.core.plans import Context
from adhoc.core.replies import ReplyFormat
from adhoc.prompting import parse
from adhoc.prompting.clean import name
from adhoc.prompting.known import Known, told_by_teammates
from adhoc.prompting.read_call import Refusal
from adhoc.prompting.reply_schema import (
    ANALYSIS,
    LONGEST_NAME,
    NUMBER,
    REASON,
    TRUTH,
    Schema,
    any_call,
    bounded_list,
    closed_object,
    id_definitions,
    nullable,
    number_below,
    one_of,
    text,
)

Prompt = Sequence[ChatMessage]


def sub_tasks_form(prompt: Prompt, context: Context, count: int, refusal: Refusal | None) -> ReplyFormat:
    """At most `count` sub-tasks; read as a tuple of candidates."""
    known, brief = Known(context, prompt), context.task
    entry = any_call(brief.sub_tasks, known, with_reason=_names(prompt, "reason"))
    schema = _reply(prompt, {"sub_tasks": bounded_list(entry, 1, count)}, known)
    return ReplyFormat(
        "sub_tasks", schema, lambda reply: parse.read_sub_tasks(reply, brief, known, count, refusal)
    )


def ranking_form(prompt: Prompt, count: int) -> ReplyFormat:
    """The numbers of `count` candidates, best first; read as a permutation of range(count)."""
    ranking = bounded_list(number_below(count), count, count)
    return ReplyFormat(
        "ranking", _reply(prompt, {"ranking": ranking}), lambda reply: parse.read_ranking(reply, count)
    )


def scores_form(prompt: Prompt, count: int) -> ReplyFormat:
    """A score for each of `count` candidates; read as a tuple with None where there is none."""
    score = closed_object({"index": number_below(count), "score": NUMBER})
    schema = _reply(prompt, {"scores": bounded_list(score, count, count)})
    return ReplyFormat("scores", schema, lambda reply: parse.read_scores(reply, count))


def verdict_form(prompt: Prompt) -> ReplyFormat:
    """Whether a sub-task is feasible, and why; read as a `Verdict`."""
    reason = {"reason": text(REASON)} if _names(prompt, "reason") else {}
    return ReplyFormat("verdict", _reply(prompt, {"feasible": TRUTH, **reason}), parse.read_verdict)


def sub_skill_form(prompt: Prompt, context: Context, refusal: Refusal | None) -> ReplyFormat:
    """One sub-skill; read as a `Call`."""
    known, brief = Known(context, prompt), context.task
    schema = _reply(prompt, {"sub_skill": any_call(brief.sub_skills, known)}, known)
    return ReplyFormat("sub_skill", schema, lambda reply: parse.read_sub_skill(reply, brief, known, refusal))


def predictions_form(prompt: Prompt, context: Context) -> ReplyFormat:
    """A sub-task and a sub-skill, or null, for each teammate; read as a tuple of predictions."""
    known, brief = Known(context, prompt, told_by_teammates(context)), context.task
    entry = closed_object(
        {
            "teammate": one_of(known.teammates) if known.teammates else text(LONGEST_NAME),
            "sub_task": nullable(any_call(brief.sub_tasks, known)),
            "sub_skill": nullable(any_call(brief.sub_skills, known)),
        }
    )
    count = len(known.teammates)
    schema = _reply(prompt, {"predictions": bounded_list(entry, count, count)}, known)
    return ReplyFormat("predictions", schema, lambda reply: parse.read_predictions(reply, brief, known))


def proposal_form(
    prompt: Prompt, context: Context, plans: Mapping[str, Call], refusal: Refusal | None
) -> ReplyFormat:
    """One sub-task, and what speaks against the plans of others; read as a `Proposal`."""
    known, brief = Known(context, prompt), context.task
    planners = [name(robot) for robot in plans]
    entry = closed_object(
        {"teammate": one_of(planners) if planners else text(LONGEST_NAME), "reason": text(REASON)}
    )
    properties = {
        "agree": TRUTH,
        "objections": bounded_list(entry, 0, max(1, len(planners))),
        "sub_task": any_call(brief.sub_tasks, known, with_reason=True),
    }
    return ReplyFormat(
        "proposal",
        _reply(prompt, properties, known),
        lambda reply: parse.read_proposal(reply, context, known, plans, refusal),
    )


def _reply(prompt: Prompt, properties: Mapping[str, Schema], known: Known | None = None) -> Schema:
    analysis = {"analysis": text(ANALYSIS)} if _names(prompt, "analysis") else {}
    schema = closed_object({**analysis, **properties})
    definitions = {} if known is None else id_definitions(known)
    return {**schema, "$defs": definitions} if definitions else schema


def _names(prompt: Prompt, field: str) -> bool:
    return f'"{field}"' in prompt[0].content
