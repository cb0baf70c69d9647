"""The contract of common sense: where things belong."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

from adhoc.core.values import Place


class CommonSense(ABC):
    """Answers where objects belong (paper: 'according to common sense')."""

    @abstractmethod
    def is_misplaced(self, category: str, receptacle: str, room_type: str) -> bool:
        """Whether an object of `category` is wrong in a receptacle of that category (or `Floor`) in a
        room of that type. Raises AssetError for a category that is not known."""

    @abstractmethod
    def places_for(self, category: str) -> Sequence[Place]:
        """Where objects of `category` belong, likeliest first; empty if nowhere is known."""
