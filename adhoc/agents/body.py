"""A robot's controller: one sub-skill at a time, turned into low-level actions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.errors import TaskError
from adhoc.core.streams import derive_seed
from adhoc.core.values import Action, Capability, Observation
from adhoc.skills.library import standard_skills
from adhoc.skills.navigator import Navigator
from adhoc.skills.skill import Skill, SkillView

SkillTable = Mapping[str, Callable[[], Skill]]


@dataclass(frozen=True)
class SkillOutcome:
    """A finished sub-skill; `failure` is None if it succeeded."""

    call: Call
    failure: str | None


class Body:
    """Executes sub-skills (paper, section Sub-skill Execution) from a robot's own memory.

    Args:
        memory: What the robot knows.
        capability: What the robot can do.
        skills: Constructors of skills by sub-skill name; the seven of the paper by default. A task with a
            sub-skill of its own passes its skill here.
    """

    def __init__(self, memory: Memory, capability: Capability, skills: SkillTable | None = None) -> None:
        table = standard_skills() if skills is None else skills
        self._memory = memory
        self._capability = capability
        self._skills = {name: build() for name, build in table.items()}
        self._navigator = Navigator(
            memory.perception.map, courtesy=1 + derive_seed(0, "courtesy", memory.me) % 6
        )
        self._others: tuple[tuple[float, float], ...] = ()
        self._focus: str | None = None
        self.call: Call | None = None
        """The sub-skill in progress, None between two."""

    def begin(
        self,
        call: Call,
        observation: Observation,
        focus_room: str | None = None,
        others: tuple[tuple[float, float], ...] = (),
    ) -> None:
        """Start a sub-skill, dropping the one in progress. Raises TaskError if there is no such skill."""
        if call.name not in self._skills:
            raise TaskError(
                f"sub-skill {call.name!r} has no skill; known skills: {', '.join(sorted(self._skills))}"
            )
        self._focus, self._others = focus_room, others
        self._skills[call.name].start(call, self._view(observation))
        self.call = call

    def interrupt(self) -> None:
        """Drop the sub-skill in progress."""
        self.call = None

    def act(self, observation: Observation) -> Action | SkillOutcome:
        """The next action of the sub-skill in progress, or its outcome. Needs a `begin` before."""
        if self.call is None:
            raise TaskError("no sub-skill is in progress; call begin() first")
        skill, call = self._skills[self.call.name], self.call
        action = skill.step(self._view(observation))
        if action is not None:
            return action
        self.call = None
        return SkillOutcome(call, skill.failure)

    def _view(self, observation: Observation) -> SkillView:
        perception = self._memory.perception
        return SkillView(
            observation,
            perception.map,
            self._navigator,
            self._capability,
            perception.objects,
            perception.rooms,
            self._focus,
            self._others,
        )
