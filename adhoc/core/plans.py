"""What planners read and produce (paper, sections IRoT and Dynamic Sub-skill Planner)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from adhoc.core.calls import Call, TaskBrief
from adhoc.core.messages import Message, TeammateView
from adhoc.core.values import Capability, ObjectRecord, Pose, RoomRecord


@dataclass(frozen=True)
class Event:
    """One line of a robot's memory: something that it did, found or failed at."""

    step: int
    text: str


@dataclass(frozen=True)
class Context:
    """The only thing a planner sees: state, messages, capability and memory of one robot at one step."""

    step: int
    task: TaskBrief
    me: str
    pose: Pose
    capability: Capability
    steps_left: int
    room: str | None
    """Id of the room the robot stands in."""
    holding: str | None
    """Id of the object in the hand."""
    objects: tuple[ObjectRecord, ...]
    """Known objects of interest and receptacles; those with `last_seen == step` are in view now."""
    rooms: tuple[RoomRecord, ...]
    teammates: tuple[TeammateView, ...]
    messages: tuple[Message, ...]
    """The latest messages, oldest first; the earliest are dropped first when space is short."""
    history: tuple[Event, ...]
    """The latest events of the robot's memory, oldest first."""
    sub_task: Call | None = None
    """The current sub-task, None before the first."""
    done: tuple[Call, ...] = ()
    """Sub-skills that succeeded since the current sub-task began, in order."""


@dataclass(frozen=True)
class Prediction:
    """What a teammate is expected to do next (the GPL-LLM baseline)."""

    teammate: str
    sub_task: Call | None = None
    sub_skill: Call | None = None


@dataclass(frozen=True)
class Candidate:
    """A proposed sub-task, why it was proposed, and its score where an evaluator gave one.

    `predictions` is what the teammates were expected to do when it was proposed; empty where the generator
    predicts nothing.
    """

    sub_task: Call
    rationale: str = ""
    score: float | None = None
    predictions: tuple[Prediction, ...] = ()


@dataclass(frozen=True)
class Objection:
    """What one robot has against another's plan, when a team negotiates."""

    objector: str
    planner: str
    """Whose plan it is."""
    sub_task: Call | None
    """The plan."""
    reason: str = ""


@dataclass(frozen=True)
class Proposal:
    """A robot's word in a negotiation (paper, appendix 'Teammates with the LLM'): what it plans to do, and
    what it has against the plans that its teammates made before; nothing if it agrees with them."""

    sub_task: Call
    rationale: str = ""
    objections: tuple[Objection, ...] = ()


@dataclass(frozen=True)
class Verdict:
    """Whether a candidate is feasible, in the light of the teammates' replies, and why."""

    feasible: bool
    reason: str = ""


@dataclass(frozen=True)
class Plan:
    """What a planner decided, with the whole way to it.

    `verdicts` pairs each judged candidate with its verdict, in the order of judgement; `rounds` counts
    generations; `fallback` names why the task's safe choice was taken, None when a candidate was accepted;
    `degraded` says which stages gave nothing usable and what was done instead.
    """

    sub_task: Call
    candidates: tuple[Candidate, ...] = ()
    ranking: tuple[Candidate, ...] = ()
    verdicts: tuple[tuple[Candidate, Verdict], ...] = ()
    replies: tuple[Message, ...] = ()
    rounds: int = 1
    fallback: str | None = None
    degraded: tuple[str, ...] = ()


class Replan(str, Enum):
    """What must be planned again after an assessment."""

    NONE = "none"
    SKILL = "skill"
    TASK = "task"


@dataclass(frozen=True)
class Assessment:
    """State assessment after an action (paper, section State Assessment).

    `ok` and `reason` are about the action or the sub-skill; `found` lists the ids of newly detected
    misplaced objects and candidate receptacles.
    """

    ok: bool
    reason: str = ""
    replan: Replan = Replan.NONE
    found: tuple[str, ...] = ()
