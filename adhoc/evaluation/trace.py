"""What happened in an episode, step by step: for pictures, transcripts and inspectors, never for scores."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from adhoc.core.messages import Message
from adhoc.core.values import Action, ActionName, Observation, Point, Pose
from adhoc.evaluation.person_counts import PersonCounts
from adhoc.evaluation.predictions import Foresight
from adhoc.worlds.world import AgentTruth, ObjectTruth

MAX_MESSAGES = 20_000
MAX_DECISIONS = 500
EVERY_STEP = ("doing", "person")
"""What robots may report at every step; it is counted, not kept."""


@dataclass(frozen=True)
class TraceStep:
    """The state after `step` steps: every robot's pose, the action that led here, and why it failed."""

    step: int
    poses: Mapping[str, Pose]
    actions: Mapping[str, str]
    failures: Mapping[str, str]


@dataclass(frozen=True)
class TraceEvent:
    """Something worth marking on a picture: a robot took or put an object, joined, or stopped.

    `kind` is `joined`, `stopped`, `battery empty`, `broke down`, `left`, `picked up`, `put down` or
    `replaced` (by whom is not said: `agent` is empty); `position` is on the floor plan, in metres.
    """

    step: int
    agent: str
    kind: str
    position: tuple[float, float]
    object_id: str | None = None


@dataclass(frozen=True)
class Decision:
    """What a policy said of its own reasoning at one step (`Turn.trace`)."""

    step: int
    agent: str
    trace: Mapping[str, Any]


@dataclass
class PlanningCounts:
    """How often robots planned, and how often it went wrong: what records count (`Turn.trace`)."""

    sub_tasks: int = 0
    """Sub-task decisions."""
    fallbacks: int = 0
    """Sub-task decisions that ended in the safe choice."""
    refused_skills: int = 0
    """Sub-skills that a planner failed to give, or gave although the robot cannot do them."""

    def add(self, trace: Mapping[str, Any]) -> None:
        """Count what one turn reported."""
        for decision in (trace.get("decision"), *trace.get("superseded", ())):
            if isinstance(decision, Mapping):
                self.sub_tasks += 1
                self.fallbacks += decision.get("fallback") is not None
        skills = trace.get("skills", ())
        self.refused_skills += sum("refused" in skill for skill in skills)


@dataclass
class Trace:
    """The trace of one episode. Messages and decisions are bounded; what did not fit is counted."""

    agents: list[str] = field(default_factory=list)
    """Names in the order of acting."""
    steps: list[TraceStep] = field(default_factory=list)
    events: list[TraceEvent] = field(default_factory=list)
    decisions: list[Decision] = field(default_factory=list)
    messages: list[Message] = field(default_factory=list)
    history: list[str] = field(default_factory=list)
    """Element t is the hash of everything that happened before step t (see `evaluation.history`)."""
    objects_before: Mapping[str, ObjectTruth] = field(default_factory=dict)
    objects_after: Mapping[str, ObjectTruth] = field(default_factory=dict)
    planning: PlanningCounts = field(default_factory=PlanningCounts)
    """The newcomer's."""
    team_planning: PlanningCounts = field(default_factory=PlanningCounts)
    foresight: Foresight = field(default_factory=Foresight)
    people: PersonCounts = field(default_factory=PersonCounts)
    dropped: int = 0
    """Messages and decisions that did not fit."""

    def add_step(
        self,
        step: int,
        agents: Mapping[str, AgentTruth],
        actions: Mapping[str, Action],
        observations: Mapping[str, Observation],
    ) -> None:
        """Note the state after `step` steps, and who took or put what since the step before."""
        failures = {
            name: observation.last_result.failure.value
            for name, observation in observations.items()
            if name in actions and observation.last_result and observation.last_result.failure
        }
        for name, action in actions.items():
            if action.name is ActionName.STOP:
                self.foresight.doings.stop(step - 1, name)
        poses = {name: truth.pose for name, truth in agents.items()}
        texts = {name: str(action) for name, action in actions.items()}
        self.steps.append(TraceStep(step, poses, texts, failures))

    def add_event(self, step: int, truth: AgentTruth, kind: str, object_id: str | None = None) -> None:
        """Note an event at the robot's place."""
        self.events.append(TraceEvent(step, truth.id, kind, (truth.pose.x, truth.pose.y), object_id))

    def add_replacement(self, step: int, object_id: str, position: Point | None) -> None:
        """Note that the referee sees an object dealt with for the first time, or again. Things that cannot be
        carried have no `position` to note; they are where they always were."""
        place = (math.nan, math.nan) if position is None else position[:2]
        self.events.append(TraceEvent(step, "", "replaced", place, object_id))

    def add_decision(self, step: int, agent: str, trace: Mapping[str, Any], of_team: bool = False) -> None:
        """Note what a policy, a teammate's or the newcomer's, reported of its decision, if anything."""
        self.foresight.add(step, agent, trace, of_team)
        self.people.add(trace)
        trace = {name: value for name, value in trace.items() if name not in EVERY_STEP}
        if not trace:
            return
        (self.team_planning if of_team else self.planning).add(trace)
        if len(self.decisions) < MAX_DECISIONS:
            self.decisions.append(Decision(step, agent, trace))
        else:
            self.dropped += 1

    def add_messages(self, messages: Iterable[Message]) -> None:
        """Note messages in the order of sending."""
        messages = list(messages)
        self.foresight.doings.hear(messages)
        for message in messages:
            if len(self.messages) < MAX_MESSAGES:
                self.messages.append(message)
            else:
                self.dropped += 1
