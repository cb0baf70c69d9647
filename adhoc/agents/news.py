"""What one step taught a robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class News:
    """What one step taught: ids of objects and rooms, in a fixed order."""

    misplaced: tuple[str, ...] = ()
    """Objects newly judged to need attention by this robot's own eyes."""
    settled: tuple[str, ...] = ()
    """Objects that needed attention and no longer do, or are gone from where they were."""
    receptacles: tuple[str, ...] = ()
    """Receptacles detected for the first time."""
    explored: tuple[str, ...] = ()
    """Rooms that this robot has finished exploring."""
    stopped: tuple[str, ...] = ()
    """Teammates that have stopped since the last step."""
    told: tuple[str, ...] = ()
    """Objects that need attention according to a teammate, unknown before."""
    placed: tuple[str, ...] = ()
    """The object that has just left the robot's hand."""


def merge_news(*several: News) -> News:
    """All that several pieces of news say, each thing once, in their order."""
    return News(
        **{
            name: tuple(dict.fromkeys(it for news in several for it in getattr(news, name)))
            for name in vars(News())
        }
    )
