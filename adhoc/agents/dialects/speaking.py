"""A robot that speaks a dialect: any policy, with its words translated on the way out and in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from adhoc.agents.dialects.dialect import Adapter, Dialect
from adhoc.agents.dialects.listening import Listener
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability, Observation
from adhoc.perception.semantic_map import SemanticMap
from adhoc.tasks.task import Task


class Speaking(Policy):
    """Lets a policy speak a dialect to the world; it decides and hears as it does without.

    Its own team understands it, since everybody's messages are translated back. What the team says to itself
    (`MessageKind.TEAM`) stays as it is.

    Args:
        policy: Decides.
        dialect: Its public messages, questions and answers are written in it.
        adapters: Formats that it understands besides the known ones (see `Listener`).
    """

    def __init__(self, policy: Policy, dialect: Dialect, adapters: Sequence[Adapter] = ()) -> None:
        self.policy = policy
        self.acts_apart = policy.acts_apart
        self._dialect = dialect
        self._listener = Listener(adapters)

    @property
    def map(self) -> SemanticMap | None:
        """See `Policy`."""
        return self.policy.map

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""

        def ask_in_dialect(message: Message) -> Sequence[Message]:
            question = self._say(message)
            return () if question is None else self._listener.understand(ask(question))

        self.policy.reset(me, capability, task, seed, ask_in_dialect)

    def confer(self, observation: Observation, inbox: Sequence[Message]) -> None:
        """See `Policy`."""
        self.policy.confer(observation, self._listener.understand(inbox))

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        turn = self.policy.act(observation, self._listener.understand(inbox))
        return replace(turn, outbox=tuple(self._all_said(turn.outbox)))

    def respond(self, message: Message) -> Message | None:
        """See `Policy`."""
        (question,) = self._listener.understand([message])
        answer = self.policy.respond(question)
        return None if answer is None else self._say(answer)

    def _all_said(self, messages: Iterable[Message]) -> Iterable[Message]:
        said = map(self._say, messages)
        return (message for message in said if message is not None)

    def _say(self, message: Message) -> Message | None:
        return message if message.kind is MessageKind.TEAM else self._dialect.write(message)
