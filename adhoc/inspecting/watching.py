"""Running an episode again to look at it, and the proof that it is the one that was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from adhoc.core.errors import EpisodeError
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.keyed_episode import run_keyed
from adhoc.evaluation.recording import unpack_history
from adhoc.evaluation.records import Record
from adhoc.inspecting.recorder import Recorder, Recording
from adhoc.worlds.world import World


@dataclass(frozen=True)
class Watched:
    """An episode that was looked at while it ran."""

    record: Record
    result: EpisodeResult
    recording: Recording


def watch_again(
    world: World, key: EpisodeKey, record: Record, alone: Record | None = None, pictures: bool = True
) -> Watched:
    """Run the episode of a record again, and record what can be seen of it.

    Args:
        world: Is reset.
        key: Names the episode; made from the configuration of the record.
        record: Of the episode.
        alone: Of the team alone in the same scenario, if `key` has a newcomer.
        pictures: Whether to take pictures at decisions.

    Raises:
        EpisodeError: It is not the episode that was recorded; the text says what differs.
        AdhocError: It cannot be run.
    """
    check_same_task(key, record)
    recorder = Recorder(key.scenario.house, pictures)
    result = run_keyed(world, key, alone, recorder)
    check_same_episode(result, record)
    return Watched(record, result, recorder.recording)


def check_same_task(key: EpisodeKey, record: Record) -> None:
    """Raise EpisodeError if a key does not name the episode of a record, which shows before it is run."""
    episode_id = record["episode_id"]
    if key.id != episode_id:
        raise EpisodeError(f"{episode_id}: its configuration makes episode {key.id!r} of it")
    for field, now, why in (
        ("scenario_hash", key.scenario_hash, "house, objects or robots of its scenario differ"),
        ("config_hash", key.kind.config_hash, "the settings of team, policy, task, world or model differ"),
    ):
        if now != record[field]:
            raise EpisodeError(
                f"{episode_id}: {field} was {record[field]} when it was recorded and is {now} now: {why}; "
                "the page would show another episode"
            )


def check_same_episode(result: EpisodeResult, record: Record) -> None:
    """Raise EpisodeError, with what differs, if an episode is not the one that was recorded."""
    differences = list(_differences(result, record))
    if differences:
        raise EpisodeError(
            f"{record['episode_id']}: run again, it is another episode: {'; '.join(differences)}. It was "
            f"made with library version {record['library_version']}; the code, a package or the machine's "
            "arithmetic differs"
        )


def _differences(result: EpisodeResult, record: Record) -> Iterator[str]:
    for field, now in (
        ("ending", result.ending.value),
        ("steps", result.steps),
        ("replaced", len(result.replaced)),
        ("messages", result.messages),
        ("history_hash", result.history_hash),
    ):
        if now != record[field]:
            yield f"{field} was {record[field]}, is {now}"
    if record.get("history"):
        recorded = unpack_history(record["history"])
        for step, (now, before) in enumerate(zip(result.history, recorded)):
            if now != before:
                yield f"the histories part before step {step}"
                return
