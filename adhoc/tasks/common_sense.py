"""The contract of common sense: where things belong."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from adhoc.core.values import Place

Triple = tuple[str, str, str]
"""The category of an object, that of a receptacle or `Floor`, and a room type."""
Judgements = Mapping[Triple, "bool | None"]
"""Whether each is misplaced; None where a judge gave no usable answer, so that it counted as in place."""

_NONE: Judgements = MappingProxyType({})


class CommonSense(ABC):
    """Answers where objects belong (paper: 'according to common sense')."""

    @abstractmethod
    def is_misplaced(self, category: str, receptacle: str, room_type: str) -> bool:
        """Whether an object of `category` is wrong in a receptacle of that category (or `Floor`) in a room
        of that type; also asked about what it has never heard of, since teammates may tell of anything."""

    @abstractmethod
    def places_for(self, category: str) -> Sequence[Place]:
        """Where objects of `category` belong, likeliest first; empty if nowhere is known."""

    def begin_episode(self) -> None:  # noqa: B027
        """Told before every episode. A judge that has to ask forgets what it was told and asks anew, so that
        the record of an episode does not depend on the episodes before it."""

    def consider(self, categories: Iterable[str]) -> None:  # noqa: B027
        """Told objects of which categories will be judged next, so that a judge can ask about all at once."""

    @property
    def fingerprint(self) -> str:
        """A hash of files that decide its answers and that a configuration only names, such as checkpoints;
        empty if nothing does. Robots that judge by it have it in theirs."""
        return ""

    @property
    def judge(self) -> str | None:
        """The language model that judges, as records name it; None if none does."""
        return None

    @property
    def judged(self) -> Judgements:
        """What a language model judged since the episode began; empty if none does."""
        return _NONE
