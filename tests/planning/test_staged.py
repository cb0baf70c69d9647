"""The course of IRoT: who is asked what, in which order, and what happens when something goes wrong."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace

from fake_situation import CONTEXT

from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Candidate, Context, Verdict
from adhoc.core.values import Capability, RoomRecord
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.evaluate import KeepOrder, LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.interfaces import Consultation, Evaluator, Reflector, SubTaskGenerator
from adhoc.planning.reflect import AcceptFirst, LLMReflector
from adhoc.planning.staged import StagedPlanner

A, B, C, D = (Candidate(Call("Search", (room,)), room) for room in "ABCD")


class Generates(SubTaskGenerator):
    def __init__(self, *rounds: Sequence[Candidate]) -> None:
        self.rounds = list(rounds)
        self.contexts: list[Context] = []

    def generate(self, context: Context) -> Sequence[Candidate]:
        self.contexts.append(context)
        return self.rounds[len(self.contexts) - 1]


class Reverses(Evaluator):
    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        return tuple(reversed(candidates))


class Refuses(Reflector):
    def __init__(self, *refused: Candidate) -> None:
        self.refused = refused
        self.seen: list[tuple[Candidate, tuple[str, ...]]] = []
        self.contexts: list[Context] = []

    def judge(self, context: Context, candidate: Candidate, replies: Sequence[Message]) -> Verdict:
        self.seen.append((candidate, tuple(it.text for it in replies)))
        self.contexts.append(context)
        return Verdict(candidate not in self.refused, f"because of {candidate.rationale}")


class Consulted:
    """Teammates that reply; the fresh context has their replies, and a room per reply."""

    def __init__(self) -> None:
        self.intentions: list[Call] = []
        self.context = CONTEXT

    def __call__(self, intention: Call) -> Consultation:
        self.intentions.append(intention)
        reply = Message(MessageKind.REPLY, f"as to {intention}", {}, None, "t", 12)
        self.context = replace(
            self.context,
            messages=(*self.context.messages, reply),
            rooms=(*self.context.rooms, RoomRecord(f"told as to {intention}")),
        )
        return Consultation((reply,), self.context)


class Fails(Evaluator, Reflector):
    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        raise ReplyError("no ranking", "unreadable")

    def judge(self, context: Context, candidate: Candidate, replies: Sequence[Message]) -> Verdict:
        raise ReplyError("no verdict", "truncated")


def test_the_first_feasible_of_the_ranking_wins() -> None:
    consult, reflector = Consulted(), Refuses(C)
    plan = StagedPlanner(Generates((A, B, C)), Reverses(), reflector).plan(CONTEXT, consult)
    assert plan.sub_task == B.sub_task
    assert plan.candidates == (A, B, C)
    assert plan.ranking == (C, B, A)
    assert [(it, verdict.feasible) for it, verdict in plan.verdicts] == [(C, False), (B, True)]
    assert consult.intentions == [C.sub_task, B.sub_task]
    assert reflector.seen == [(C, ("as to Search C",)), (B, ("as to Search B",))]
    assert [it.text for it in plan.replies] == ["as to Search C", "as to Search B"]
    assert (plan.rounds, plan.fallback, plan.degraded) == (1, None, ())


def test_all_refused_generates_again_with_what_was_learnt() -> None:
    generator = Generates((A, B), (A, D))
    consult = Consulted()
    plan = StagedPlanner(generator, KeepOrder(), Refuses(A, B)).plan(CONTEXT, consult)
    assert (plan.sub_task, plan.rounds, plan.fallback) == (D.sub_task, 2, None)
    first, second = generator.contexts
    assert first is CONTEXT
    assert [it.text for it in second.messages[len(CONTEXT.messages) :]] == [
        "as to Search A",
        "as to Search B",
    ]
    assert [it.text for it in second.history[len(CONTEXT.history) :]] == [
        "judged infeasible: Search A (because: because of A)",
        "judged infeasible: Search B (because: because of B)",
    ]
    assert consult.intentions == [A.sub_task, B.sub_task, D.sub_task], "what was refused is not asked again"


def _told(context: Context) -> list[str]:
    return [it.id for it in context.rooms[len(CONTEXT.rooms) :]]


def _remembered(context: Context) -> list[str]:
    return [it.text for it in context.history[len(CONTEXT.history) :]]


def test_candidates_are_judged_by_what_the_replies_told_and_by_earlier_verdicts() -> None:
    generator, reflector, consult = Generates((A, B), (C,)), Refuses(A, B), Consulted()
    StagedPlanner(generator, KeepOrder(), reflector).plan(CONTEXT, consult)
    as_to_a, as_to_b, as_to_c = (f"told as to Search {it}" for it in "ABC")
    about_a, about_b = (f"judged infeasible: Search {it} (because: because of {it})" for it in "AB")
    first, second, third = reflector.contexts
    assert (_told(first), _remembered(first)) == ([as_to_a], [])
    assert (_told(second), _remembered(second)) == ([as_to_a, as_to_b], [about_a])
    assert (_told(generator.contexts[1]), _remembered(generator.contexts[1])) == (
        [as_to_a, as_to_b],
        [about_a, about_b],
    )
    assert (_told(third), _remembered(third)) == ([as_to_a, as_to_b, as_to_c], [about_a, about_b])
    assert third.messages == consult.context.messages, "the context has the replies; none is added twice"


def test_rounds_are_bounded_and_the_fallback_says_why() -> None:
    generator = Generates((A,), (B,), (C,))
    plan = StagedPlanner(generator, KeepOrder(), Refuses(A, B, C), max_rounds=3).plan(CONTEXT, Consulted())
    assert len(generator.contexts) == 3
    assert plan.sub_task == CONTEXT.task.fallback
    assert plan.fallback == "all candidates were refused in 3 rounds"
    assert len(plan.verdicts) == 3


def test_what_the_task_forbids_is_refused_without_asking_anybody() -> None:
    consult, reflector = Consulted(), Refuses()

    def legal(call: Call, capability: Capability) -> str | None:
        return "A is out of bounds" if call == A.sub_task else None

    plan = StagedPlanner(Generates((A, B)), KeepOrder(), reflector, legal=legal).plan(CONTEXT, consult)
    assert plan.sub_task == B.sub_task
    assert plan.verdicts[0] == (A, Verdict(False, "A is out of bounds"))
    assert consult.intentions == [B.sub_task]
    assert [it for it, _ in reflector.seen] == [B]


def test_without_a_task_the_need_for_hands_is_checked() -> None:
    handless = replace(CONTEXT, capability=Capability(can_manipulate=False))
    deliver = Candidate(Call("Deliver", ("Letter|1", "Tray", "Office")))
    unknown = Candidate(Call("Fly"))
    planner = StagedPlanner(Generates((deliver, unknown, A)), KeepOrder(), AcceptFirst())
    plan = planner.plan(handless, Consulted())
    assert plan.sub_task == A.sub_task
    assert "manipulation" in plan.verdicts[0][1].reason
    assert "'Fly'" in plan.verdicts[1][1].reason
    planner = StagedPlanner(Generates((deliver,)), KeepOrder(), AcceptFirst())
    assert planner.plan(CONTEXT, Consulted()).sub_task == deliver.sub_task


def test_nobody_is_asked_without_reflection() -> None:
    consult = Consulted()
    plan = StagedPlanner(Generates((A, B)), KeepOrder(), AcceptFirst()).plan(CONTEXT, consult)
    assert plan.sub_task == A.sub_task
    assert consult.intentions == []


def test_a_useless_ranking_keeps_the_order_and_says_so() -> None:
    plan = StagedPlanner(Generates((A, B)), Fails(), Refuses()).plan(CONTEXT, Consulted())
    assert plan.ranking == (A, B)
    assert plan.degraded == ("evaluation gave nothing usable (unreadable): kept the order",)


def test_a_missing_verdict_accepts_or_refuses_as_configured_and_says_so() -> None:
    plan = StagedPlanner(Generates((A, B)), KeepOrder(), Fails()).plan(CONTEXT, Consulted())
    assert plan.sub_task == A.sub_task
    assert plan.degraded == ("reflection gave nothing usable (truncated): accepted Search A",)
    strict = StagedPlanner(Generates((A,), (B,)), KeepOrder(), Fails(), accept_unjudged=False)
    plan = strict.plan(CONTEXT, Consulted())
    assert plan.fallback
    assert len(plan.degraded) == 2


def test_the_paper_s_figure_with_a_scripted_model() -> None:
    """Three candidates A, B, C are ranked B, A, C; B is judged infeasible, then A is chosen."""
    places = [{"name": "Search", "args": [f"room|{it}"], "reason": ""} for it in (1, 2, 3)]
    model = ScriptedModel(
        [
            json.dumps({"analysis": "...", "sub_tasks": places}),
            '{"analysis": "...", "ranking": [1, 0, 2]}',
            '{"analysis": "...", "feasible": false, "reason": "taken"}',
            '{"analysis": "...", "feasible": true, "reason": "free"}',
        ]
    )
    planner = StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model))
    consult = Consulted()
    plan = planner.plan(CONTEXT, consult)
    assert plan.sub_task == Call("Search", ("room|1",))
    assert [it.stage for it in model.requests] == ["generate", "evaluate", "reflect", "reflect"]
    assert consult.intentions == [Call("Search", ("room|2",)), Call("Search", ("room|1",))]
    last = model.requests[-1].messages[1].content
    assert '- t: "as to Search room|1"' in last
    assert "judged infeasible: Search room|2 (because: taken)" in last
