"""What a run was to do, from its provenance: the configuration built again, here."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from adhoc.cli.comparing import comparisons_of, provider_of
from adhoc.cli.config_errors import one_line
from adhoc.cli.replaying import replay_config
from adhoc.cli.trust import check_trusted
from adhoc.core.errors import ConfigurationError, DatasetError, RecordError
from adhoc.evaluation.episode_key import EpisodeKind
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.recording import newcomer_label
from adhoc.experiments.comparison import Comparison
from adhoc.experiments.provenance.file import Provenance
from adhoc.experiments.provenance.outside import file_hash, outside_code
from adhoc.experiments.provenance.private import at_home
from adhoc.experiments.verifying.origin import PlannedEpisode, RunPlan

_SHARD = re.compile(r"(\d+)/(\d+)")
WHOLE = "1/1"


class RebuiltRun:
    """One run of a folder, built again from its provenance; no model is asked.

    Args:
        folder: The run folder.
        facts: What decided the run.
        moved: Where files lie here that lay elsewhere, by their keys in the configuration.
        trust: Whether components that are not of this library may be built, which runs their code.

    Raises:
        RecordError: A file outside the library that the run needs is not here, or is another one.
        AdhocError: Something cannot be built.
    """

    def __init__(self, folder: Path, facts: Provenance, moved: Mapping[str, str], trust: bool) -> None:
        self._facts = facts
        if not trust:
            check_trusted(facts.config)
        check_outside(facts, moved)
        try:
            self.config: DictConfig = replay_config(facts.config, folder)
            for key, path in moved.items():
                if key in facts.data["files"]:
                    OmegaConf.update(self.config, key, path)
        except OmegaConfBaseException as error:
            raise ConfigurationError(one_line(error)) from error
        self._comparisons = comparisons_of([self.config], provider_of(self.config), self._known)

    @property
    def comparison(self) -> Comparison:
        """The team, its scenarios, and the newcomer. Raises AdhocError if it cannot be built here."""
        comparison: Comparison = self._comparisons[0]
        return comparison

    @cached_property
    def positions(self) -> Mapping[str, int]:
        """Where in the list of scenarios each is, by its id."""
        return {name: place for place, name in enumerate(scenario_ids(self.comparison.scenarios))}

    def _known(self, place: int, fingerprints: Mapping[str, str]) -> str:
        check_data(self._facts, fingerprints)
        return self._facts.run

    def plan(self) -> RunPlan:
        """The episodes of the run, and those of them that its sessions were to run.

        A session that ran one of n parts counts only together with those of the other parts: which episodes
        are in a part depends on all that was run with it.
        """
        kinds = self.comparison.kinds
        possible = {}
        for kind in kinds:
            told = _told_of(kind)
            possible.update({kind.id_in(name): PlannedEpisode(name, told) for name in self.positions})
        most = scenarios_wanted(self._facts.sessions, len(self.positions))
        wanted = frozenset(kind.id_in(name) for name in list(self.positions)[:most] for kind in kinds)
        return RunPlan(possible, wanted)

    def close(self) -> None:
        """Free the simulator."""
        self._comparisons.close()


def _told_of(kind: EpisodeKind) -> Mapping[str, Any]:
    """What records of this kind of episode say."""
    conditions, newcomer = kind.conditions, kind.newcomer
    return {
        "config_hash": kind.config_hash,
        "team": conditions.team_name,
        "team_label": conditions.team_label,
        "policy": kind.policy,
        "policy_label": newcomer_label(newcomer),
        "join_step": kind.join_step,
        "model": kind.model,
        "team_model": kind.team_model,
    }


def check_outside(facts: Provenance, moved: Mapping[str, str]) -> None:
    """Raise RecordError, naming file, checksum and key, if something outside the library that a run needs is
    not here, or is not what it was."""
    for key, file in facts.data["files"].items():
        path = Path(moved.get(key) or at_home(str(file["path"])))
        needed = f"{Path(file['path']).name} with SHA-256 {file['sha256']} ({file['bytes']} bytes)"
        if not path.exists():
            raise RecordError(
                f"{key}: {path} is not here; the run needs {needed}: put it there, or name it with --file "
                f"{key}=PATH"
            )
        found, size = file_hash(path)
        if found != file["sha256"]:
            raise RecordError(f"{key}: {path} has SHA-256 {found} ({size} bytes); the run needs {needed}")
    here = outside_code(facts.config)
    for name, digest in facts.code.get("modules", {}).items():
        if here.get(name) is None and digest is not None:
            raise ConfigurationError(
                f"the module {name!r} is not here, which the configuration takes components from; the run "
                f"needs it with SHA-256 {digest}: put it on PYTHONPATH"
            )


def check_data(facts: Provenance, fingerprints: Mapping[str, str]) -> None:
    """Raise DatasetError if the benchmark, or a checkpoint, is not what it was in the run."""
    for name, now in fingerprints.items():
        before = facts.data.get(name)
        if before and now and before != now:
            raise DatasetError(
                f"data.{name}: the files here have the fingerprint {now[:16]}; those of the run had "
                f"{before[:16]}: use the release of the library that the run was made with"
            )


def scenarios_wanted(sessions: Sequence[Mapping[str, Any]], scenarios: int) -> int:
    """How many of so many scenarios, from the first, the sessions of a run were to run."""
    parts: dict[int | None, set[str]] = {}
    for session in sessions:
        options = session.get("options") or {}
        parts.setdefault(options.get("limit"), set()).add(str(options.get("shard") or WHOLE))
    whole = [limit for limit, shards in parts.items() if _is_whole(shards)]
    return max((scenarios if limit is None else int(limit) for limit in whole), default=0)


def _is_whole(shards: set[str]) -> bool:
    """Whether the parts of a run, as `2/4`, are all there."""
    found = [(int(it[1]), int(it[2])) for it in map(_SHARD.fullmatch, shards) if it is not None]
    return any(
        {number for number, of in found if of == count} >= set(range(1, count + 1)) for _, count in found
    )
