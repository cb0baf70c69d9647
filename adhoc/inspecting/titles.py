"""What episodes that are shown together are called."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence

from adhoc.evaluation.records import Record

_ADDITIONS: Sequence[Callable[[Record], str]] = (
    lambda record: "" if record["join_step"] is None else f" t{record['join_step']}",
    lambda record: f" {record['model'] or record['policy']}",
    lambda record: f" beside {record['team_label']}",
)


def titles(records: Sequence[Record], alone: str = "team alone") -> list[str]:
    """A title of its own for each episode, such as `with IRoT-LLM`.

    As much of joining step, model, team and place in the row is added as is needed to tell them apart.

    Args:
        records: Of the episodes.
        alone: What the team alone is called.
    """
    found = [alone if it["join_step"] is None else f"with {it['policy_label']}" for it in records]
    for addition in _ADDITIONS:
        found = _told_apart(found, [addition(it) for it in records])
    return _told_apart(found, [f" #{place}" for place in range(1, len(records) + 1)])


def _told_apart(found: Sequence[str], additions: Sequence[str]) -> list[str]:
    """The titles, with their additions where those of equal titles differ."""
    of_title: defaultdict[str, set[str]] = defaultdict(set)
    for title, addition in zip(found, additions):
        of_title[title].add(addition)
    return [
        f"{title}{addition}" if len(of_title[title]) > 1 else title
        for title, addition in zip(found, additions)
    ]
