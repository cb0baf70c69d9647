"""What every robot that talks is made of: a memory, a body, a voice, and the step it is in."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from typing import Any

from adhoc.agents import communication
from adhoc.agents.body import Body, SkillTable
from adhoc.agents.memory import Memory
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.agents.voice import Voice
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.values import Action, Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.perception.semantic_map import SemanticMap
from adhoc.tasks.task import Task


class TalkingPolicy(Policy):
    """Remembers what it sees and hears, and answers by what it knows (paper, section Communication).

    Args:
        perception: Settings of its perception.
        skills: Skills by sub-skill name; the paper's by default.
    """

    def __init__(self, perception: PerceptionSettings | None, skills: SkillTable | None) -> None:
        self._perception, self._skills = perception, skills

    @property
    def map(self) -> SemanticMap | None:
        """See `Policy`."""
        memory: Memory | None = getattr(self, "_memory", None)
        return None if memory is None else memory.perception.map

    def _wake(self, me: str, capability: Capability, task: Task, ask: Ask) -> None:
        """Begin an episode with an empty memory."""
        self._me, self._capability, self._task = me, capability, task
        self._memory = Memory(me, task, self._perception)
        self._body = Body(self._memory, capability, self._skills)
        self._voice = Voice(self._memory, capability, ask)
        self._outbox: list[Message] = []
        self._observation: Observation | None = None

    def respond(self, message: Message) -> Message | None:
        """A newcomer's `join` is answered by the own state, an `intention` by what is known."""
        return None if self._observation is None else self._voice.answer(message, self._state())

    @abstractmethod
    def _has_stopped(self) -> bool:
        """Whether it chose to stop."""

    @abstractmethod
    def _doing(self) -> tuple[Call | None, Call | None]:
        """Its sub-task and its sub-skill, as others are told."""

    @property
    def _now(self) -> Observation:
        assert self._observation is not None
        return self._observation

    @property
    def _position(self) -> tuple[float, float]:
        return (self._now.pose.x, self._now.pose.y)

    def _room(self) -> str | None:
        """The room it is in, as far as it knows."""
        return self._memory.perception.map.room_at(*self._position)

    def _out_of_order(self) -> bool:
        """Whether this robot does nothing any more after this step: stopped, or its last step of battery."""
        return self._has_stopped() or self._now.steps_left <= 1

    def _state(self) -> dict[str, Any]:
        return self._voice.state(self._now, *self._doing(), self._out_of_order())

    def _report(self, *message: Message | None) -> None:
        """Begin what is said in this step."""
        self._outbox = [it for it in message if it is not None]

    def _tell(self, events: Iterable[str]) -> None:
        """Tell everybody what happened, if anything did, and the state that came of it."""
        text = " ".join(f"{event}." for event in events)
        if text:
            self._outbox.append(communication.task_state_message(text, self._state()))

    def _tell_events(self, events: list[str]) -> None:
        """As `_tell`, and that the battery is empty when it is."""
        if self._now.steps_left == 1 and not self._has_stopped():
            events.append("My battery is empty")
        self._tell(events)

    def _turn(self, action: Action, trace: Mapping[str, Any]) -> Turn:
        """What this step came to; what is said is remembered."""
        self._memory.remember_sent(self._outbox)
        return Turn(action, tuple(self._outbox), trace)
