"""Observing teammates: from what is heard and seen to deeds in situations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.memory import Memory
from adhoc.agents.plastic.deeds import Doing, Heard, Seen, attended, doing, searched
from adhoc.agents.plastic.situation import Situation
from adhoc.core.geometry import planar_distance
from adhoc.core.messages import TeammateView
from adhoc.tasks.task import Task

STILL = 0.3
"""Metres within which a robot seen twice counts as staying: less than two of its moves."""
NEARER = 0.3
"""Metres by which a robot has to come nearer to an object to count as nearing it."""


@dataclass(frozen=True, eq=False)
class Behaviour:
    """One observed deed of one teammate."""

    teammate: str
    step: int
    deed: Heard | Seen
    features: NDArray[np.float64]
    """The situation before the deed, see `situation.FEATURES`."""


class Watch:
    """Turns a newcomer's own knowledge into observed behaviour, and nothing else does it look at.

    Two channels: every message of a teammate, in whatever way it was understood, shows what its sender is
    at (`Heard`), unless nothing that was ever said could be understood; two glimpses of a robot, `glimpse` to
    twice as many steps apart, show whether and where it moves (`Seen`). One that speaks shows something by
    not speaking for `pause` steps too: it goes on with what it did. After `trust` steps of silence that is
    not believed any more; it may be out of order, or the radio may be. A teammate that is neither heard nor
    seen has no behaviour.

    Args:
        memory: What the newcomer knows; to be asked after it took in a step.
        task: Tells search and work on objects apart.
        glimpse: Steps between two glimpses.
        pause: Steps of silence that count as going on.
        trust: Steps of silence after which nothing is concluded from it.
    """

    def __init__(
        self, memory: Memory, task: Task, glimpse: int = 5, pause: int = 10, trust: int = 30
    ) -> None:
        self._memory, self._task = memory, task
        self._glimpse, self._pause, self._trust = glimpse, pause, trust
        self._views: dict[str, TeammateView] = {}
        self._noted: dict[str, int] = {}
        self._began: dict[str, int] = {}
        self._known_since: dict[str, int] = {}
        self._seen: dict[str, tuple[int, tuple[float, float]]] = {}

    def observe(self, step: int, robots: Mapping[str, tuple[float, float]]) -> list[Behaviour]:
        """The deeds that were observed in a step; `robots` are those in view, and where (`Sighting`)."""
        for record in self._memory.attention():
            self._known_since.setdefault(record.id, step)
        heard = [self._heard(step, name) for name in sorted(self._memory.teammates)]
        seen = [self._glimpsed(step, name, robots[name]) for name in sorted(robots)]
        self._views = dict(self._memory.teammates)
        return [it for it in (*heard, *seen) if it is not None]

    def _spoke(self, name: str) -> bool:
        view = self._memory.teammates[name]
        return view != self._views.get(name) and view != TeammateView(name, last_heard=view.last_heard)

    def _heard(self, step: int, name: str) -> Behaviour | None:
        spoke = self._spoke(name)
        if not spoke and not self._paused(step, name):
            return None
        self._noted[name] = step
        situation = self._situation(step, name, self._memory.teammates[name].position)
        deed = self._deed(situation) if spoke else Heard.CONTINUES
        if deed not in (Heard.REPORTS, Heard.CONTINUES):
            self._began[name] = step
        return Behaviour(name, step, deed, situation.features())

    def _paused(self, step: int, name: str) -> bool:
        view = self._memory.teammates[name]
        if view.stopped or name not in self._noted or step - view.last_heard > self._trust:
            return False
        return step - self._noted[name] >= self._pause

    def _deed(self, situation: Situation) -> Heard:
        before, now, task = situation.before, situation.now, self._task
        was, is_now = doing(before, task), doing(now, task)
        if is_now is Doing.STOPPED:
            return Heard.REPORTS if was is Doing.STOPPED else Heard.STOPS
        if before is not None and _same_work(before, now, task) and was is is_now:
            return Heard.REPORTS
        if is_now is Doing.ATTENDING:
            return self._attending(situation)
        room = searched(now.sub_task, task)
        if room is None:
            return Heard.IDLES
        goes = now.sub_skill is not None and room in now.sub_skill.args
        elsewhere = goes or now.room not in (None, room)
        if elsewhere:
            return Heard.SEARCHES_ELSEWHERE
        return Heard.SEARCHES_TOGETHER if situation.company_in(room) else Heard.SEARCHES_HERE

    def _attending(self, situation: Situation) -> Heard:
        name = attended(situation.now, self._task)
        if any(attended(view, self._task) == name and not view.stopped for view in situation.others):
            return Heard.ATTENDS_CONTESTED
        record = next((it for it in self._memory.attention() if it.id == name), None)
        nearest = situation.nearest()
        if record is None:
            return Heard.ATTENDS
        if situation.closer_teammate(record):
            return Heard.ATTENDS_OUT_OF_TURN
        past = nearest is not None and nearest.id != name
        return Heard.ATTENDS_PAST_NEARER if past else Heard.ATTENDS

    def _glimpsed(self, step: int, name: str, place: tuple[float, float]) -> Behaviour | None:
        before = self._seen.get(name)
        if before is not None and step - before[0] < self._glimpse:
            return None
        self._seen[name] = (step, place)
        if before is None or step - before[0] > 2 * self._glimpse:
            return None
        situation = self._situation(step, name, before[1])
        return Behaviour(name, step, self._motion(situation, before[1], place), situation.features())

    def _motion(self, situation: Situation, before: tuple[float, float], place: tuple[float, float]) -> Seen:
        if planar_distance(before, place) < STILL:
            return Seen.STAYS
        nearest = situation.nearest()
        if nearest is None:
            return Seen.MOVES
        gained = planar_distance(before, nearest.position) - planar_distance(place, nearest.position)
        return Seen.NEARS_OBJECT if gained >= NEARER else Seen.MOVES

    def _situation(self, step: int, name: str, place: tuple[float, float] | None) -> Situation:
        teammates = self._memory.teammates
        others = [view for other, view in sorted(teammates.items()) if other != name]
        now = teammates.get(name) or TeammateView(name)
        began = self._began.get(name, 0)
        return Situation(
            name,
            self._views.get(name),
            now,
            others,
            place,
            self._memory,
            self._task,
            step,
            began,
            self._known_since,
        )


def _same_work(before: TeammateView, now: TeammateView, task: Task) -> bool:
    at_objects = attended(before, task) == attended(now, task)
    return at_objects and searched(before.sub_task, task) == searched(now.sub_task, task)
