"""Thousands of malformed replies: no crash, a typed outcome for each, nothing illegal chosen."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from fake_situation import CONTEXT
from hypothesis import given
from hypothesis import strategies as st
from malformed_replies import malformed

from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.core.plans import Candidate, Context, Verdict
from adhoc.core.replies import DUPLICATE, EMPTY, ILLEGAL, TRUNCATED, UNKNOWN_ID, UNREADABLE
from adhoc.core.values import Capability
from adhoc.llm.counting import CountingModel, Counts
from adhoc.llm.model import LanguageModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.gpl import GPLEvaluator, GPLGenerator
from adhoc.planning.negotiate import LLMNegotiator
from adhoc.planning.reflect import LLMReflector
from adhoc.planning.sub_skill import LLMSubSkillPlanner

HANDLESS = replace(CONTEXT, capability=Capability(can_manipulate=False))
"""It may search and rest, not deliver."""
WRONG = {EMPTY, TRUNCATED, UNREADABLE, ILLEGAL, DUPLICATE, UNKNOWN_ID}
PLANS = {"teammate_1": Call("Deliver", ("Letter|2", "Tray", "Office")), "teammate_2": Call("Rest")}
CANDIDATES = tuple(Candidate(Call("Search", (room.id,))) for room in CONTEXT.rooms[:3])

GOOD: dict[str, Any] = {
    "generate": {
        "analysis": "near",
        "sub_tasks": [
            {"name": "Search", "args": ["room|3"], "reason": "unexplored"},
            {"name": "Deliver", "args": ["Letter|1", "Tray", "Office"], "reason": "misplaced"},
        ],
    },
    "evaluate": {"analysis": "so", "ranking": [2, 0, 1]},
    "reflect": {"analysis": "free", "feasible": True, "reason": "nobody is at it"},
    "sub_skill": {"analysis": "next", "sub_skill": {"name": "Approach", "args": ["Letter|1"]}},
    "gpl_predict": {
        "analysis": "on",
        "predictions": [
            {
                "teammate": "teammate_1",
                "sub_task": {"name": "Deliver", "args": ["Letter|2", "Tray", "Office"]},
                "sub_skill": {"name": "Grab", "args": ["Letter|2"]},
            }
        ],
    },
    "negotiate": {
        "analysis": "so",
        "agree": False,
        "objections": [{"teammate": "teammate_1", "reason": "it cannot lift that"}],
        "sub_task": {"name": "Search", "args": ["room|3"], "reason": "unexplored"},
    },
    "gpl_score": {"analysis": "so", "scores": [{"index": 0, "score": 7}, {"index": 1, "score": 2.5}]},
}
BEYOND = {"sub_task": {"name": "Deliver", "args": ["Letter|1", "Tray", "Office"], "reason": "near"}}
"""What a robot without a hand cannot plan."""
CORPUS = {stage: tuple(dict.fromkeys(malformed(json.dumps(good)))) for stage, good in GOOD.items()}
CORPUS["negotiate"] += tuple(malformed(json.dumps({**GOOD["negotiate"], **BEYOND})))


def ask(stage: str, model: LanguageModel, context: Context = HANDLESS) -> Any:
    """One question of a stage."""
    if stage == "generate":
        return LLMGenerator(model).generate(context)
    if stage == "evaluate":
        return LLMEvaluator(model).rank(context, CANDIDATES)
    if stage == "reflect":
        return LLMReflector(model).judge(context, CANDIDATES[0], ())
    if stage == "sub_skill":
        return LLMSubSkillPlanner(model).next_skill(context, CANDIDATES[0].sub_task, None)
    if stage == "negotiate":
        return LLMNegotiator(model).propose(context, PLANS)
    if stage == "gpl_score":
        return GPLEvaluator(model).rank(context, CANDIDATES)
    return GPLGenerator(model).generate(context)


def check_call(call: Call, allowed: set[str]) -> None:
    assert call.name in allowed
    known = {it.id for it in (*CONTEXT.objects, *CONTEXT.rooms)} | {"Floor"}
    assert all(isinstance(it, float) or it in known for it in call.args)


def check_answer(stage: str, answer: Any) -> None:
    """Whatever is made of a reply is of the right type, and within what the robot may do."""
    if stage == "reflect":
        assert isinstance(answer, Verdict)
        assert isinstance(answer.feasible, bool)
    elif stage == "sub_skill":
        check_call(answer, {"Approach", "WalkBy", "WalkTo", "Rest", "LookAround"})
    elif stage == "negotiate":
        check_call(answer.sub_task, {"Search", "Rest"})
        assert {(it.planner, it.sub_task) for it in answer.objections} <= set(PLANS.items())
        assert all(isinstance(it.reason, str) for it in answer.objections)
    elif stage in ("evaluate", "gpl_score"):
        assert {it.sub_task for it in answer} == {it.sub_task for it in CANDIDATES}
    else:
        assert 0 < len(answer) <= 3
        for candidate in answer:
            check_call(candidate.sub_task, {"Search", "Rest"})


def ends(counts: Counts) -> int:
    """Questions that ended, by their counts; all that is counted must be of a known kind."""
    judged = {"valid", "repaired", "invalid"}
    assert set(counts.outcomes) <= judged | WRONG
    return sum(counts.outcomes[it] for it in judged)


def ask_badly(stage: str, *replies: str) -> Counts:
    """Ask one question that is answered so; the counts of its stage."""
    replies = (*replies, json.dumps(GOOD["generate"])) if stage == "gpl_predict" else replies
    model = CountingModel(ScriptedModel(replies))
    with contextlib.suppress(ReplyError):
        check_answer(stage, ask(stage, model))
    counts = model.stages[stage]
    assert ends(counts) == 1
    return counts


def test_the_corpus_is_large_and_bad() -> None:
    assert sum(map(len, CORPUS.values())) >= 1000
    for stage, replies in CORPUS.items():
        usable = sum(ask_badly(stage, reply, "").outcomes["valid"] for reply in replies[::7])
        assert usable < len(replies[::7]) / 2


@pytest.mark.parametrize("stage", CORPUS)
def test_every_malformed_reply_ends_in_a_typed_outcome(stage: str) -> None:
    for first, second in zip(CORPUS[stage], reversed(CORPUS[stage])):
        ask_badly(stage, first, second)


@pytest.mark.parametrize("stage", CORPUS)
def test_a_good_reply_mends_every_malformed_one(stage: str) -> None:
    for reply in CORPUS[stage][::5]:
        counts = ask_badly(stage, reply, json.dumps(GOOD[stage]))
        assert counts.invalid == 0
        assert counts.calls == 1 + counts.repaired


@st.composite
def spoiled(draw: Callable[..., Any]) -> tuple[str, str]:
    """A stage and its good reply with a few stretches replaced by others."""
    stage = draw(st.sampled_from(sorted(GOOD)))
    text = json.dumps(GOOD[stage])
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        end = start + draw(st.integers(0, 12))
        text = text[:start] + draw(st.text(alphabet="{}[]:,\"'\\/#0-9aNI \n\ud800", max_size=8)) + text[end:]
    return stage, text


@given(spoiled())
def test_random_damage_ends_in_a_typed_outcome_too(reply: tuple[str, str]) -> None:
    ask_badly(reply[0], reply[1], reply[1])
