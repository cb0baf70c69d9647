"""Running the episode that a key names."""

from __future__ import annotations

from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.observer import BLIND, EpisodeObserver
from adhoc.evaluation.recording import unpack_history
from adhoc.evaluation.records import Record
from adhoc.llm.counting import CountingModel
from adhoc.worlds.world import World


def run_keyed(
    world: World, key: EpisodeKey, alone: Record | None = None, observer: EpisodeObserver = BLIND
) -> EpisodeResult:
    """Run one episode with fresh policies, after its models were told that it begins.

    With `alone`, the record of the team alone in the same scenario, the past up to the joining step is
    checked against it. Raises what `run_episode` raises.
    """
    kind, scenario = key.kind, key.scenario
    conditions, newcomer = kind.conditions, kind.newcomer
    for model in models_of(key):
        model.begin_episode(key.id, scenario.seed)
    return run_episode(
        world,
        scenario,
        conditions.task,
        [conditions.team.make(seat) for seat in range(len(scenario.team))],
        None if newcomer is None else newcomer.make(len(scenario.team)),
        0 if kind.join_step is None else kind.join_step,
        conditions.max_steps,
        conditions.referee,
        None if alone is None else unpack_history(alone["history"]),
        conditions.imperfections,
        observer,
    )


def models_of(key: EpisodeKey) -> list[CountingModel]:
    """The models of team, newcomer and task; a shared one once."""
    conditions, newcomer = key.kind.conditions, key.kind.newcomer
    contenders = [conditions.team, *([] if newcomer is None else [newcomer])]
    asked = [conditions.model, *(one.model for one in contenders)]
    return list({id(model): model for model in asked if model is not None}.values())
