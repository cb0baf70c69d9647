"""Numbers of things in words of the right number."""

from __future__ import annotations


def counted(number: int, thing: str) -> str:
    """So many of a thing, e.g. `1 house`, `1,200 episodes`; for nouns whose plural takes an `s`."""
    return f"{number:,} {thing}{'' if number == 1 else 's'}"
