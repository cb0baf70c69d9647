"""The episodes of a run folder, run again from what the folder says of itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.contestants import Components
from adhoc.cli.model_chain import LedgerMode, is_offline
from adhoc.cli.trust import check_trusted
from adhoc.core.errors import EpisodeError, RecordError
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.records import Record, RecordFile
from adhoc.evaluation.scenario import Scenario
from adhoc.experiments.provenance.file import read_provenance
from adhoc.experiments.provenance.private import at_home
from adhoc.inspecting.watching import Watched, watch_again

LEDGER = "ledger"
"""The folder of recorded calls in a run folder."""


class ReplayFolder:
    """Replays episodes of one run folder; no call of a language model is made.

    The configuration of a record comes from `provenance/<run>.json`, answers of language models from the
    folder's ledger; the offline reasoner, where its calls were not recorded, answers again.

    Args:
        folder: The run folder.
        trust: Whether components that are not of this library may be built, which runs their code.
        configs: Configurations by run, in place of those in the folder.

    Raises:
        RecordError: There are no records, or they are damaged.
    """

    def __init__(
        self,
        folder: str | Path,
        trust: bool = False,
        configs: Mapping[str, Mapping[str, Any]] | None = None,
    ) -> None:
        self.path, self._trust = Path(folder), trust
        file = RecordFile(folder)
        self.records = file.read()
        if not self.records:
            raise RecordError(f"{file.path}: there are no records; DIR must be the folder of a run")
        self._configs = configs or {}
        self._built: dict[str, tuple[DictConfig, Components]] = {}

    def record(self, episode_id: str) -> Record:
        """The record of an episode. Raises RecordError if there is none."""
        for record in self.records:
            if record["episode_id"] == episode_id:
                return record
        ids = [str(record["episode_id"]) for record in self.records]
        near = get_close_matches(episode_id, ids, 3, 0.3) or ids[:3]
        raise RecordError(
            f"{self.path}: no episode {episode_id!r} among {len(ids)}; there are e.g. {', '.join(near)}"
        )

    def alone(self, record: Record) -> Record:
        """The record of the team alone in the scenario of a record, or the record itself if it is one. Raises
        RecordError if there is none."""
        if record["join_step"] is None:
            return record
        _, components = self._rebuilt(record)
        return self.record(EpisodeKind(components.conditions).id_in(str(record["task_id"])))

    def replay(self, episode_id: str, pictures: bool = True) -> Watched:
        """Run an episode again, and look at it.

        Raises:
            RecordError: There is no such episode, or no configuration of it.
            LedgerError: The ledger is missing, damaged, or lacks a call.
            EpisodeError: It is not the episode that was recorded.
            AdhocError: It cannot be run.
        """
        record = self.record(episode_id)
        config, components = self._rebuilt(record)
        scenario = _scenario(config, components, record)
        if record["join_step"] is None:
            key = EpisodeKey(scenario, EpisodeKind(components.conditions))
            return watch_again(components.world, key, record, None, pictures)
        if components.newcomer is None:
            raise RecordError(f"{episode_id}: the configuration of its run has no ad hoc robot")
        kind = EpisodeKind(components.conditions, components.newcomer, int(record["join_step"]))
        key = EpisodeKey(scenario, kind)
        return watch_again(components.world, key, record, self.alone(record), pictures)

    def close(self) -> None:
        """Free the simulators."""
        for _, components in self._built.values():
            components.world.close()
        self._built.clear()

    def _rebuilt(self, record: Record) -> tuple[DictConfig, Components]:
        """The configuration of the record's run, and what is built from it."""
        run = record.get("run")
        if not isinstance(run, str):
            raise RecordError(
                f"{self.path}: {record['episode_id']}: field 'run' is {run!r}: the record does not say of "
                "which run it is, so that its configuration is not known; it was made by an earlier version"
            )
        if run not in self._built:
            config = self._configs[run] if run in self._configs else read_provenance(self.path, run).config
            if not self._trust:
                check_trusted(config)
            composed = replay_config(config, self.path)
            self._built[run] = composed, Components(composed)
        return self._built[run]


def _scenario(config: DictConfig, components: Components, record: Record) -> Scenario:
    scenarios = components.benchmark.scenarios(components.world, config.seed)
    ids: Sequence[str] = scenario_ids(scenarios)
    if record["task_id"] not in ids:
        raise EpisodeError(
            f"{record['episode_id']}: the benchmark of its run has no scenario {record['task_id']!r} now"
        )
    return scenarios[list(ids).index(record["task_id"])]


def replay_config(config: Mapping[str, Any], folder: Path) -> DictConfig:
    """The configuration of a run, so that nobody is asked or paid.

    Answers come from the ledger in `folder`, or where the configuration says that it is. The offline reasoner
    answers again, unless there is a ledger.
    """
    composed = OmegaConf.create(_at_home(config))
    composed.out, composed.workers, composed.limit = str(folder), 1, None
    composed.budget.run = {"calls": None, "tokens": None, "usd": None}
    named = composed.ledger.path
    path = folder / LEDGER if named is None or not Path(named).exists() else Path(named)
    if path.exists() or not is_offline(composed.llm):
        composed.ledger.mode, composed.ledger.path = LedgerMode.REPLAY.value, str(path)
    else:
        composed.ledger.mode = LedgerMode.OFF.value
    return composed


def _at_home(value: Any) -> Any:
    """Plain values, with `~` as the home folder of whoever reads them."""
    if isinstance(value, str):
        return at_home(value)
    if isinstance(value, Mapping):
        return {name: _at_home(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_at_home(inner) for inner in value]
    return value
