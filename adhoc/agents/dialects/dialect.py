"""What a dialect is: a way to write public messages, and the adapter that reads them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from adhoc.core.messages import Message


class Adapter(ABC):
    """Reads the messages of teams of one kind (paper, section Communication: 'This interface extracts
    capability and state information from the message format of teammates' models').

    The text that it reads was written by a stranger. So `read` takes any text and never raises, in time that
    grows no faster than the text; what it returns is checked again by whoever asked (see `Listener`).
    """

    name: ClassVar[str]
    """As records call it."""
    plain: ClassVar[bool] = False
    """Whether its messages are in plain language. Where they are not, planners that read texts are given
    what was understood in sentences."""

    @abstractmethod
    def read(self, message: Message) -> Mapping[str, Any] | None:
        """What the message says, as the payload that `agents.communication` lays out and reads.

        Fields that it does not mention are left out. None where it is not in this format.
        """


class Dialect(Adapter):
    """A format that robots speak, with its own adapter."""

    @abstractmethod
    def write(self, message: Message) -> Message | None:
        """A message, as the robot's policy means it, in this format; None where nothing is said.

        Kind and recipient stay. A message whose payload says nothing that this format has words for stays as
        it is.
        """
