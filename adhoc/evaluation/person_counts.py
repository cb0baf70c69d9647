"""What became of the lines that a person typed who played a robot: what records count (`Turn.trace`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any


@dataclass
class PersonCounts:
    """The counts of one episode, over all robots that people play."""

    lines: int = 0
    """Lines typed, or taken from a script."""
    refused: int = 0
    """Those that were no commands, or that the robot cannot do."""
    given_up: int = 0
    """Steps in which the robot waited since nothing that was typed was a command."""
    strayed: int = 0
    """Lines of a recorded session that were taken in another situation than that in which they were typed."""
    left: int = 0
    """People who left before the end."""

    def add(self, trace: Mapping[str, Any]) -> None:
        """Count what one turn reported."""
        counts = trace.get("person")
        if isinstance(counts, Mapping):
            for count in fields(self):
                setattr(self, count.name, getattr(self, count.name) + int(counts.get(count.name, 0)))
