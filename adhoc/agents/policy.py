"""The contract of a policy: the mind of one robot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from adhoc.core.messages import Message
from adhoc.core.values import Action, Capability, Observation
from adhoc.tasks.task import Task

if TYPE_CHECKING:
    from adhoc.perception.semantic_map import SemanticMap

Ask = Callable[[Message], Sequence[Message]]
"""Broadcasts a message and returns the teammates' answers within the step."""


@dataclass(frozen=True)
class Turn:
    """What a robot does in one step: one action, and messages that arrive at the next step."""

    action: Action
    outbox: tuple[Message, ...] = ()
    trace: Mapping[str, Any] = field(default_factory=dict)
    """For transcripts and inspectors only: what was decided and why. JSON values. Never an input."""


class Policy(ABC):
    """Decides for one robot from its own observations and the messages it receives, and nothing else."""

    acts_apart: bool = False
    """Whether `act` asks no robot anything. Robots of which this is true act side by side: what they ask
    language models in one step goes out together (`llm.side_by_side`)."""

    @property
    def fingerprint(self) -> str:
        """A hash of what decides its behaviour besides its configuration, such as trained weights; empty if
        nothing does. Episodes of another fingerprint are not taken for its own."""
        return ""

    @property
    def map(self) -> SemanticMap | None:
        """What it knows of space, for inspectors: looked at, never changed, and an input to nobody.

        None if it keeps no map, or before `reset`.
        """
        return None

    @abstractmethod
    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """Begin an episode as the robot `me`. All its randomness comes from
        `core.streams.stream(seed, "agent", me)`.

        `ask` may be called during `confer` and, unless the robot `acts_apart`, during `act` only.
        """

    def confer(self, observation: Observation, inbox: Sequence[Message]) -> None:  # noqa: B027
        """The first part of a step, which all robots go through one after the other before any of them acts:
        to come to terms, by `ask`. Most robots need none. `act` of the same step is given the same again.
        """

    @abstractmethod
    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """One step: what to do and what to say. `Stop` is for good: once chosen, it is all that follows.

        `inbox` holds the messages sent to this robot or to everybody in the previous step, never its own.
        """

    def respond(self, message: Message) -> Message | None:
        """Answer a question within the step (see `MessageKind.INTENTION`, `JOIN`), or stay silent."""
        return None
