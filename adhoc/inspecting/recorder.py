"""Recording an episode while it is run: everything that a page or a film of it shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from adhoc.agents.policy import Policy, Turn
from adhoc.core.values import Observation, Pose
from adhoc.evaluation.trace import EVERY_STEP
from adhoc.houses.house import House
from adhoc.inspecting.field_of_view import view_outline
from adhoc.inspecting.known_floor import FloorGrid, FloorLog
from adhoc.inspecting.snapshots import snapshot
from adhoc.perception.settings import PerceptionSettings
from adhoc.worlds.world import AgentTruth, ObjectTruth, World

KEY_FRAME = 5
"""Steps between two notes of what floor is known."""
MAX_DECISIONS = 5_000
SELDOM = 1e-3
"""Metres below which an object did not move."""


@dataclass
class Track:
    """One robot from the step at which it came, element by step."""

    first: int
    poses: list[Pose] = field(default_factory=list)
    held: list[str | None] = field(default_factory=list)
    views: list[int] = field(default_factory=list)
    """Numbers of outlines (see `Recording.views`)."""
    actions: list[str] = field(default_factory=list)
    """What it did next, with its target; empty if it did nothing."""


@dataclass(frozen=True)
class ObjectMove:
    """An object that is somewhere else from a step on, or in or out of a hand."""

    step: int
    object: ObjectTruth


@dataclass(frozen=True)
class RecordedDecision:
    """What a robot reported of its reasoning at one step (`Turn.trace`), and what it saw there."""

    step: int
    robot: str
    trace: Mapping[str, Any]
    picture: int | None
    """Number of its picture."""

    @property
    def is_sub_task(self) -> bool:
        """Whether a sub-task was decided, and not a sub-skill alone."""
        return isinstance(self.trace.get("decision"), Mapping)


@dataclass
class Recording:
    """What was seen of one episode, besides its `EpisodeResult`."""

    grid: FloorGrid
    reach: float
    """Metres along the optical axis that count as seen."""
    tracks: dict[str, Track] = field(default_factory=dict)
    views: list[bytes] = field(default_factory=list)
    """Outlines of fields of view (see `field_of_view.view_outline`), each once."""
    floors: dict[str, FloorLog] = field(default_factory=dict)
    """Of robots that keep a map."""
    objects: dict[str, ObjectTruth] = field(default_factory=dict)
    """Where every object that can be picked up was at first."""
    moves: list[ObjectMove] = field(default_factory=list)
    doings: dict[str, list[tuple[int, str | None, str | None]]] = field(default_factory=dict)
    """Sub-task and sub-skill of a robot, from which step on."""
    decisions: list[RecordedDecision] = field(default_factory=list)
    pictures: dict[int, bytes] = field(default_factory=dict)
    """JPEG files by number."""
    left_out: int = 0
    """Decisions that did not fit."""


class Recorder:
    """An `EpisodeObserver` that keeps what it is shown.

    Args:
        house: Where the episode is.
        pictures: Whether to take pictures at decisions: about a hundredth of a second each.
        reach: Metres along the optical axis that count as seen; as far as robots look by default.
    """

    def __init__(self, house: House, pictures: bool = True, reach: float | None = None) -> None:
        reach = PerceptionSettings().max_depth if reach is None else reach
        self.recording = Recording(FloorGrid.of(house), reach)
        self._takes_pictures = pictures
        self._view_numbers: dict[bytes, int] = {}
        self._places: dict[str, ObjectTruth] = {}

    def look(
        self,
        step: int,
        world: World,
        policies: Mapping[str, Policy],
        observations: Mapping[str, Observation],
        turns: Mapping[str, Turn],
    ) -> None:
        """See `EpisodeObserver`."""
        present = world.agents()
        for robot, truth in present.items():
            self._note_robot(step, truth, observations.get(robot), turns.get(robot))
        self._note_objects(step, world.truth())
        if step % KEY_FRAME == 0 or not turns:
            self._note_floors(step, policies)
        for robot, turn in turns.items():
            self._note_doing(step, robot, turn.trace.get("doing"))
            self._note_decision(step, robot, turn.trace, world if robot in present else None)

    def _note_robot(
        self, step: int, truth: AgentTruth, observation: Observation | None, turn: Turn | None
    ) -> None:
        track = self.recording.tracks.setdefault(truth.id, Track(step))
        track.poses.append(truth.pose)
        track.held.append(truth.held)
        track.views.append(-1 if observation is None else self._view_number(observation))
        track.actions.append("" if turn is None else str(turn.action))

    def _view_number(self, observation: Observation) -> int:
        outline = view_outline(observation, self.recording.reach).tobytes()
        number = self._view_numbers.setdefault(outline, len(self._view_numbers))
        if number == len(self.recording.views):
            self.recording.views.append(outline)
        return number

    def _note_objects(self, step: int, objects: Mapping[str, ObjectTruth]) -> None:
        if not self._places:
            self.recording.objects = dict(objects)
        for name, truth in objects.items():
            before = self._places.get(name)
            if before is not None and _is_elsewhere(before, truth):
                self.recording.moves.append(ObjectMove(step, truth))
        self._places = dict(objects)

    def _note_floors(self, step: int, policies: Mapping[str, Policy]) -> None:
        for robot, policy in policies.items():
            space = policy.map
            if space is not None:
                self.recording.floors.setdefault(robot, FloorLog(self.recording.grid)).note(step, space)

    def _note_doing(self, step: int, robot: str, doing: Any) -> None:
        if not isinstance(doing, Mapping):
            return
        entries = self.recording.doings.setdefault(robot, [])
        now = doing.get("sub_task"), doing.get("sub_skill")
        if not entries or entries[-1][1:] != now:
            entries.append((step, *now))

    def _note_decision(self, step: int, robot: str, trace: Mapping[str, Any], world: World | None) -> None:
        told = {name: value for name, value in trace.items() if name not in EVERY_STEP}
        if not told:
            return
        if len(self.recording.decisions) >= MAX_DECISIONS:
            self.recording.left_out += 1
            return
        number = None
        if self._takes_pictures and world is not None:
            number = len(self.recording.pictures)
            self.recording.pictures[number] = snapshot(world, robot)
        self.recording.decisions.append(RecordedDecision(step, robot, told, number))


def _is_elsewhere(before: ObjectTruth, now: ObjectTruth) -> bool:
    if (before.holder, before.receptacle) != (now.holder, now.receptacle):
        return True
    if now.holder is not None:
        return False
    return any(abs(a - b) > SELDOM for a, b in zip(before.position, now.position))
