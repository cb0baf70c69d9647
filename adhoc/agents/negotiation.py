"""How a team that plans in turn comes to terms (paper, appendix 'Teammates with the LLM')."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from adhoc.agents.crew import Crew, objection_message, plan_message
from adhoc.agents.policy import Ask
from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.plans import Candidate, Context, Objection, Plan, Proposal
from adhoc.planning.interfaces import Negotiator


class Negotiation:
    """One robot's turn: it says what it has against the plans so far, has those planned again, then plans.

    Args:
        negotiator: Speaks for the robot.
        crew: What the other members plan.
        ask: Asks them.
        rounds: How often it may object before it plans; it ends earlier if nobody makes another plan. What it
            still has against others' plans after that is noted and has no effect: a team that cannot agree
            acts all the same.

    Raises:
        ConfigurationError: rounds is negative.
    """

    def __init__(self, negotiator: Negotiator, crew: Crew, ask: Ask, rounds: int) -> None:
        if rounds < 0:
            raise ConfigurationError(f"rounds={rounds} must not be negative")
        self._negotiator, self._crew, self._ask, self._rounds = negotiator, crew, ask, rounds
        self._revised: dict[str, Call] = {}

    def agree(
        self,
        context: Callable[[], Context],
        objections: Sequence[Objection],
        changes: Sequence[str],
        keeps: Call | None,
    ) -> tuple[Plan, tuple[Objection, ...]]:
        """The robot's plan, and what it had against others'.

        A robot that is objected to (`objections`) objects to nobody meanwhile. Where the model gives no
        usable reply, the robot keeps to what it was at (`keeps`), and if it cannot, takes the safe choice.
        """
        raised: list[Objection] = []
        self._revised = {}
        proposals: list[Proposal] = []
        rounds = 0 if objections else self._rounds
        try:
            for left in range(rounds, -1, -1):
                now = self._with_plans(context())
                proposals.append(
                    self._negotiator.propose(now, self._crew.plans(now.step), objections, changes)
                )
                raised.extend(proposals[-1].objections)
                if left == 0 or not self._raise_all(proposals[-1].objections, now.step):
                    break
        except ReplyError as error:
            reason = f"no sub-task was proposed ({error.outcome}): {error}"
            return _fall_back(context(), proposals, keeps, reason), tuple(raised)
        return _plan(proposals, proposals[-1].sub_task), tuple(raised)

    def announce(self, sub_task: Call | None) -> None:
        """Tell all members at once, so that those who plan after this robot know its plan, and those which
        were made again because of it."""
        self._ask(plan_message(sub_task, revised=self._revised))

    def _raise_all(self, objections: Sequence[Objection], step: int) -> bool:
        """Whether anybody made another plan because of the objections."""
        return sum(self._raise(objection, step) for objection in objections) > 0

    def _raise(self, objection: Objection, step: int) -> bool:
        for answer in self._ask(objection_message(objection)):
            self._crew.hear(answer, step)
        plan = self._crew.plans(step).get(objection.planner)
        if plan is None or plan == objection.sub_task:
            return False
        self._revised[objection.planner] = plan
        return True

    def _with_plans(self, context: Context) -> Context:
        """The context in which what members do is what they plan now."""
        plans = self._crew.plans(context.step)
        views = (replace(it, sub_task=plans.get(it.name, it.sub_task)) for it in context.teammates)
        return replace(context, teammates=tuple(views))


def _fall_back(context: Context, proposals: Sequence[Proposal], keeps: Call | None, reason: str) -> Plan:
    """The last proposal if there was one, else what the robot was at, else the safe choice."""
    if proposals:
        return _plan(proposals, proposals[-1].sub_task, reason)
    return _plan(proposals, keeps or context.task.fallback, reason)


def _plan(proposals: Sequence[Proposal], sub_task: Call, fallback: str | None = None) -> Plan:
    candidates = tuple(Candidate(it.sub_task, it.rationale) for it in proposals)
    return Plan(sub_task, candidates, rounds=max(1, len(proposals)), fallback=fallback)
