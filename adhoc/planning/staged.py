"""Interactive Reflection of Thoughts: generate, rank, then ask and judge one after the other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.messages import Message
from adhoc.core.plans import Candidate, Context, Event, Plan, Verdict
from adhoc.planning.interfaces import Consult, Evaluator, Planner, Reflector, SubTaskGenerator
from adhoc.planning.legality import Legal, refusal_by


class StagedPlanner(Planner):
    """The paper's sub-task planner (section Dynamic Sub-Task Planner with IRoT), in exchangeable stages.

    The first candidate of the ranking that is legal and judged feasible wins. If all are refused, the
    planner generates again with what it has learnt. Every candidate is judged, and everything that follows is
    decided, in the context that the consultation gave: objects, rooms, teammates and messages are up to date
    with the replies. The verdicts join its memory.

    Args:
        generator: Stage 1.
        evaluator: Stage 2; without a usable ranking, the order of generation stays.
        reflector: Stage 3; without a usable verdict, see `accept_unjudged`.
        legal: The task's own check, `Task.legal`. What it refuses is never shared with the teammates. None:
            only the vocabulary's need for manipulation is checked.
        max_rounds: How often candidates are generated at most. The paper re-plans without a bound; one
            regeneration keeps the cost of a step in sight.
        accept_unjudged: Whether a candidate counts as feasible when the model gives no usable verdict. True
            by default: it is legal and was ranked first, and a wrong choice is mended at the next
            assessment, whereas refusing would idle the robot because of a malformed reply.

    Raises:
        ConfigurationError: max_rounds is below 1.
    """

    def __init__(
        self,
        generator: SubTaskGenerator,
        evaluator: Evaluator,
        reflector: Reflector,
        legal: Legal | None = None,
        max_rounds: int = 2,
        accept_unjudged: bool = True,
    ) -> None:
        if max_rounds < 1:
            raise ConfigurationError(f"StagedPlanner: max_rounds is {max_rounds}, it must be at least 1")
        self._generator, self._evaluator, self._reflector = generator, evaluator, reflector
        self._legal, self._max_rounds, self._accept_unjudged = legal, max_rounds, accept_unjudged

    def plan(self, context: Context, consult: Consult) -> Plan:
        """See `Planner`."""
        trail = _Trail()
        for _ in range(self._max_rounds):
            trail.rounds += 1
            try:
                trail.candidates = tuple(self._generator.generate(context))
            except ReplyError as error:
                return trail.fall_back(context, f"no candidate was generated ({error.outcome}): {error}")
            trail.ranking = self._rank(context, trail)
            for candidate in trail.ranking:
                verdict, context = self._judge(context, candidate, consult, trail)
                if verdict.feasible:
                    return trail.accept(candidate)
                context = _with(context, [trail.learn(context.step, candidate, verdict)])
        return trail.fall_back(context, f"all candidates were refused in {trail.rounds} rounds")

    def _rank(self, context: Context, trail: _Trail) -> tuple[Candidate, ...]:
        try:
            return tuple(self._evaluator.rank(context, trail.candidates))
        except ReplyError as error:
            trail.degraded.append(f"evaluation gave nothing usable ({error.outcome}): kept the order")
            return trail.candidates

    def _judge(
        self, context: Context, candidate: Candidate, consult: Consult, trail: _Trail
    ) -> tuple[Verdict, Context]:
        """The verdict, and the context as it is after the teammates have been asked."""
        refusal = trail.refusal_of(candidate) or self._illegality(context, candidate)
        if refusal is not None:
            return trail.judged(candidate, Verdict(False, refusal)), context
        replies: tuple[Message, ...] = ()
        if self._reflector.consults:
            consultation = consult(candidate.sub_task)
            context, replies = _with(consultation.context, trail.events), consultation.replies
            trail.replies.extend(replies)
        try:
            verdict = self._reflector.judge(context, candidate, replies)
        except ReplyError as error:
            done = "accepted" if self._accept_unjudged else "refused"
            trail.degraded.append(
                f"reflection gave nothing usable ({error.outcome}): {done} {candidate.sub_task}"
            )
            verdict = Verdict(self._accept_unjudged, f"{done} without a verdict: {error}")
        return trail.judged(candidate, verdict), context

    def _illegality(self, context: Context, candidate: Candidate) -> str | None:
        return refusal_by(self._legal, context.task.sub_tasks, context.capability)(candidate.sub_task)


@dataclass
class _Trail:
    """The way to a plan."""

    candidates: tuple[Candidate, ...] = ()
    ranking: tuple[Candidate, ...] = ()
    verdicts: list[tuple[Candidate, Verdict]] = field(default_factory=list)
    replies: list[Message] = field(default_factory=list)
    degraded: list[str] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    """The refusals as lines of memory; a fresh context does not have them."""
    rounds: int = 0

    def judged(self, candidate: Candidate, verdict: Verdict) -> Verdict:
        self.verdicts.append((candidate, verdict))
        return verdict

    def learn(self, step: int, candidate: Candidate, verdict: Verdict) -> Event:
        """The refusal as a line of memory."""
        event = Event(step, f"judged infeasible: {candidate.sub_task} (because: {verdict.reason})")
        self.events.append(event)
        return event

    def refusal_of(self, candidate: Candidate) -> str | None:
        """Why the same sub-task was refused before, so that nobody is asked twice within a step."""
        for earlier, verdict in self.verdicts:
            if earlier.sub_task == candidate.sub_task:
                return verdict.reason or "already refused"
        return None

    def accept(self, candidate: Candidate) -> Plan:
        return self._plan(candidate.sub_task, None)

    def fall_back(self, context: Context, reason: str) -> Plan:
        return self._plan(context.task.fallback, reason)

    def _plan(self, sub_task: Call, fallback: str | None) -> Plan:
        return Plan(
            sub_task,
            self.candidates,
            self.ranking,
            tuple(self.verdicts),
            tuple(self.replies),
            self.rounds,
            fallback,
            tuple(self.degraded),
        )


def _with(context: Context, events: Iterable[Event]) -> Context:
    """The context with the events at the end of its memory."""
    return replace(context, history=(*context.history, *events))
