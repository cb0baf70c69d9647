"""One session of a run: its provenance is written when it begins, and completed when it ends."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from adhoc.experiments.provenance.asked_models import asked_models
from adhoc.experiments.provenance.code_state import code_state, torch_version
from adhoc.experiments.provenance.file import (
    NOT_DECIDING,
    Provenance,
    read_provenance,
    update_last_session,
    write_provenance,
)
from adhoc.experiments.provenance.machine import machine_facts
from adhoc.experiments.provenance.outside import outside_code, outside_files
from adhoc.experiments.provenance.private import publishable, publishable_argument
from adhoc.llm.ledger.translation import utc_now
from adhoc.prompting.library import shipped_prompts

LEDGER_NAME = "ledger"
"""The folder in the run folder where calls of models are recorded, unless the configuration names another."""


@contextmanager
def run_session(
    folder: str | Path, config: Mapping[str, Any], fingerprints: Mapping[str, str] | None = None
) -> Iterator[str]:
    """A session of a run, from before its first episode until after its last; gives the run's id.

    See `begin_session` and `end_session`. A session that is interrupted is completed as well; one whose
    process is killed lacks its end, and the models' dates are then only in the ledger.
    """
    run = begin_session(folder, config, fingerprints)
    try:
        yield run
    finally:
        end_session(folder, run)


def begin_session(
    folder: str | Path,
    config: Mapping[str, Any],
    fingerprints: Mapping[str, str] | None = None,
    command: Sequence[str] | None = None,
) -> str:
    """Write what decides the episodes of a run to `folder/provenance/RUN.json`, and return the run's id, the
    field `run` of every record.

    Neither keys nor the home folder are written (see `private`). The caller holds the folder's lock.

    Args:
        folder: The run folder.
        config: The composed configuration as plain values.
        fingerprints: What the components say of their data: `benchmark`, and the checkpoints by their place.
        command: The command line; that of the process if None.

    Raises:
        RecordError: The file cannot be written, one of that name is of another run, or a file that the
            configuration names cannot be read.
    """
    return write_provenance(folder, provenance_of(config, fingerprints, [_session(config, command)]))


def end_session(folder: str | Path, run: str, complete: bool = True) -> None:
    """Add to the latest session of a run when it ended, and which models answered under which names and when,
    as its ledger tells. Raises RecordError or LedgerError if a file is damaged."""
    there = read_provenance(folder, run)
    started = str(there.sessions[-1]["started"])
    models = asked_models(ledger_of(there.config, folder), since=started)
    update_last_session(
        folder, run, {"ended": utc_now(), "complete": complete, "models": models, "torch": torch_version()}
    )


def provenance_of(
    config: Mapping[str, Any],
    fingerprints: Mapping[str, str] | None = None,
    sessions: Sequence[Mapping[str, Any]] = (),
) -> Provenance:
    """What decides a run that is configured so and is run by this process, without writing it."""
    known = {name: value for name, value in (fingerprints or {}).items() if value}
    return Provenance(
        publishable(config),
        {**code_state(), "modules": outside_code(config)},
        {**known, "prompts": shipped_prompts().fingerprint, "files": outside_files(config)},
        sessions,
    )


def ledger_of(config: Mapping[str, Any], folder: str | Path) -> Path:
    """Where the calls of a run with this configuration are recorded."""
    ledger = config.get("ledger")
    path = ledger.get("path") if isinstance(ledger, Mapping) else None
    return Path(folder) / LEDGER_NAME if path is None else Path(path).expanduser()


def _session(config: Mapping[str, Any], command: Sequence[str] | None) -> dict[str, Any]:
    words = sys.argv if command is None else command
    program = [Path(word).name for word in words[:1]]
    return {
        "started": utc_now(),
        "ended": None,
        "complete": False,
        "command": [*program, *map(publishable_argument, words[1:])],
        "options": publishable({name: config[name] for name in NOT_DECIDING if name in config}),
        "machine": machine_facts(),
        "models": {},
        "torch": torch_version(),
    }
