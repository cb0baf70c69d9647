"""The contracts of planning. Planner variants are compositions of these, not subclasses of each other."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.plans import Assessment, Candidate, Context, Objection, Plan, Proposal, Verdict


@dataclass(frozen=True)
class Consultation:
    """What came of sharing an intention: the replies, and the context with what they told."""

    replies: tuple[Message, ...]
    context: Context
    """Objects, rooms, teammates and messages are up to date with the replies."""


Consult = Callable[[Call], Consultation]
"""Shares an intention with the teammates and returns what they replied, within the step."""


class SubTaskGenerator(ABC):
    """Stage 1 of IRoT: Generation of Candidate Sub-Tasks."""

    @abstractmethod
    def generate(self, context: Context) -> Sequence[Candidate]:
        """Distinct candidate sub-tasks, at least one. Raises ReplyError if the model gave none."""


class Evaluator(ABC):
    """Stage 2 of IRoT: Evaluation and Ranking."""

    @abstractmethod
    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        """A permutation of `candidates`, best first. Raises ReplyError if the model gave no ranking."""


class Reflector(ABC):
    """Stage 3 of IRoT: Interactive Reflection."""

    consults: bool = True
    """Whether the teammates are asked before `judge`; `replies` is empty where not."""

    @abstractmethod
    def judge(self, context: Context, candidate: Candidate, replies: Sequence[Message]) -> Verdict:
        """Whether the candidate is feasible in the light of the replies.

        `context` is the one that the consultation gave: what the replies told is in it already. Raises
        ReplyError if the model gave no verdict."""


class Planner(ABC):
    """Chooses the next sub-task."""

    @abstractmethod
    def plan(self, context: Context, consult: Consult) -> Plan:
        """The next sub-task. `consult` asks the teammates; what it returns replaces `context`.

        Never raises ReplyError: what the model gets wrong ends in
        `Plan.fallback`. Raises ModelError if the model cannot be used at all."""


class Negotiator(ABC):
    """Speaks for a robot whose team agrees on its sub-tasks (paper, appendix 'Teammates with the LLM')."""

    @abstractmethod
    def propose(
        self,
        context: Context,
        plans: Mapping[str, Call],
        objections: Sequence[Objection] = (),
        changes: Sequence[str] = (),
    ) -> Proposal:
        """The robot's next sub-task in the light of the plans that were made before, and what it has against
        those.

        Args:
            context: What the robot knows.
            plans: The sub-task of every member of the team that has one, in the order of planning.
            objections: What members have against this robot's own plan; it is asked for another one then.
            changes: What has changed in the team, a sentence each: the paper's adaptive prompts.

        Raises ReplyError if the model gave no sub-task."""


class SubSkillPlanner(ABC):
    """Chooses the next sub-skill of a sub-task."""

    @abstractmethod
    def next_skill(self, context: Context, sub_task: Call, last: Assessment | None) -> Call:
        """The next sub-skill. Raises ReplyError if the model gave none; the agent then re-plans."""
