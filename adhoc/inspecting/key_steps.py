"""The steps of an episode that tell its story."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.floor_shapes import spaced
from adhoc.evaluation.trace import TraceEvent

COUNT = 5
"""About as many as a row of the paper's figure has."""
_RANKS = ("joined", "replaced", "picked up", "put down", "broke down", "left", "stopped", "battery empty")
"""What is shown first where there is not room for all."""


@dataclass(frozen=True)
class KeyStep:
    """A step, and what happened there, e.g. `teammate 1 takes Mug (2)`, the second misplaced object."""

    step: int
    captions: tuple[str, ...]


def key_steps(result: EpisodeResult, count: int = COUNT) -> list[KeyStep]:
    """At most `count` steps at which something happened, in order; the end of the episode is the last.

    The joining comes before what became of the misplaced objects, and that before robots that stopped; of
    equals, the earlier. Events about objects that were not misplaced are left out.
    """
    by_step: dict[int, list[TraceEvent]] = {result.steps: []}
    for event in result.trace.events:
        if event.object_id is None or event.object_id in result.watched:
            by_step.setdefault(event.step, []).append(event)
    ranked = sorted(by_step, key=lambda step: (step != result.steps, _rank(by_step[step]), step))
    chosen = sorted(ranked[:count])
    end = "done" if result.success else result.ending.value
    return [
        KeyStep(step, (*_told(by_step[step], result), *([end] if step == result.steps else [])))
        for step in chosen
    ]


def _rank(events: Sequence[TraceEvent]) -> int:
    return min((_RANKS.index(event.kind) for event in events if event.kind in _RANKS), default=len(_RANKS))


def _told(events: Sequence[TraceEvent], result: EpisodeResult) -> list[str]:
    placed = {event.object_id for event in events if event.kind == "replaced"}
    put = {event.object_id for event in events if event.kind == "put down"}
    captions = []
    for event in events:
        name = event.agent.replace("_", " ")
        if event.object_id is None:
            captions.append(f"{name} {'joins' if event.kind == 'joined' else event.kind}")
            continue
        number = result.watched.index(event.object_id) + 1
        thing = f"{spaced(result.scenario.house.object(event.object_id).category)} ({number})"
        if event.kind == "put down":
            captions.append(f"{name} puts {thing}{' in place' if event.object_id in placed else ''}")
        elif event.kind == "picked up":
            captions.append(f"{name} takes {thing}")
        elif event.object_id not in put:
            captions.append(f"{thing} in place")
    return captions
