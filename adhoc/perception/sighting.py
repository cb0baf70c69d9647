"""What one observation showed and changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Sighting:
    """What one observation showed and changed; ids of objects, in the order of their first detection."""

    visible: tuple[str, ...] = ()
    """Objects and receptacles in view; not walls, floors or robots."""
    new: tuple[str, ...] = ()
    """Seen by own eyes for the first time, or again after being gone or forgotten."""
    moved: tuple[str, ...] = ()
    """Seen elsewhere than recorded: `moved_distance` away, or in another receptacle or room."""
    gone: tuple[str, ...] = ()
    """Believed at a place that is in full view now, and not there; they are forgotten."""
    robots: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Other robots in view, and where."""
