"""Choosing houses of each number of rooms from a large collection, whatever its order."""

from __future__ import annotations

import hashlib
import heapq
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from adhoc.core.errors import ConfigurationError


@dataclass(frozen=True, order=True)
class Candidate:
    """One house of a collection, not yet parsed; candidates are in the order of their ranks."""

    rank: str
    """A hash of seed and content."""
    source: str = field(compare=False)
    text: str = field(compare=False, repr=False)


def choose(
    documents: Iterable[tuple[str, object]], counts: Sequence[int], most: int, seed: int
) -> Mapping[int, tuple[Candidate, ...]]:
    """The first `most` houses of each number of rooms, in the order of their ranks.

    A rank depends on the seed and on what the document says, so neither the order of the documents nor
    other houses change which houses come first. Equal houses count once.

    Args:
        documents: Where each is from, and its JSON value.
        counts: The numbers of rooms that are wanted.
        most: How many of each are kept.
        seed: Another seed chooses others.
    """
    best: dict[int, dict[str, Candidate]] = {rooms: {} for rooms in counts}
    for source, value in documents:
        rooms = _rooms(value)
        if rooms in best:
            text = json.dumps(value, separators=(",", ":"), sort_keys=True)
            rank = hashlib.sha256(f"{seed}:{text}".encode()).hexdigest()
            kept = best[rooms]
            kept.setdefault(rank, Candidate(rank, source, text))
            if len(kept) > most:
                del kept[max(kept)]
    return {rooms: tuple(heapq.nsmallest(most, kept.values())) for rooms, kept in best.items()}


def check_enough(chosen: Mapping[int, Sequence[Candidate]], needed: int, where: str) -> None:
    """Raise ConfigurationError unless there are `needed` candidates of each number of rooms."""
    for rooms, candidates in chosen.items():
        if len(candidates) < needed:
            raise ConfigurationError(
                f"{where}: {len(candidates)} houses with {rooms} rooms were found, {needed} are needed; "
                "lower benchmark.houses_per_count, or leave that number out of benchmark.counts"
            )


def _rooms(value: object) -> int | None:
    """The number of rooms of a house document; None for anything else."""
    rooms = value.get("rooms") if isinstance(value, dict) else None
    return len(rooms) if isinstance(rooms, list) else None
