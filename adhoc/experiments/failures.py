"""Episodes that failed: what went wrong, kept beside the records, and how much of it a run bears."""

from __future__ import annotations

import errno
import json
import math
import traceback
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from adhoc import __version__
from adhoc.core.errors import (
    BudgetReached,
    CheckpointError,
    ConfigurationError,
    LedgerError,
    MissingDependency,
    ModelError,
    PromptError,
    RecordError,
    TaskError,
    WorkerError,
)
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.records import writing
from adhoc.prompting.clean import one_line

FAILURES_NAME = "failures.jsonl"
LONGEST_MESSAGE = 1000
"""Characters; the trace has the whole."""
ENDS_THE_RUN = (
    BudgetReached,
    CheckpointError,
    ConfigurationError,
    LedgerError,
    MemoryError,
    MissingDependency,
    ModelError,
    PromptError,
    RecordError,
    TaskError,
    WorkerError,
)
"""What would go wrong in the next episode as well: the configuration, the records, the provider."""
DISK_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)
"""Numbers of the OSErrors that would, too; any other is the episode's own, such as a policy's lost
connection."""


@dataclass(frozen=True)
class Failure:
    """An episode that raised an error. It is no result, and it is run again by the next run of its folder."""

    episode_id: str
    task_id: str
    team: str
    policy: str
    join_step: int | None
    error: str
    """The class of the error."""
    message: str
    trace: str
    """Where it was raised, for a developer."""
    library_version: str

    @classmethod
    def of(cls, key: EpisodeKey, error: BaseException) -> Failure:
        """What went wrong in an episode."""
        kind, told = key.kind, traceback.TracebackException.from_exception(error)
        return cls(
            key.id,
            key.scenario_id,
            kind.conditions.team_name,
            kind.policy,
            kind.join_step,
            type(error).__name__,
            one_line(str(told), LONGEST_MESSAGE),
            "".join(told.format()),
            __version__,
        )


def ends_the_run(error: BaseException) -> bool:
    """Whether it would go wrong in the next episode as well."""
    return isinstance(error, ENDS_THE_RUN) or (isinstance(error, OSError) and error.errno in DISK_FULL)


class FailureFile:
    """The `failures.jsonl` of a run folder: one line for each episode whose latest attempt failed.

    Raises RecordError if it cannot be read.
    """

    def __init__(self, folder: str | Path) -> None:
        self.path = Path(folder) / FAILURES_NAME
        self._failures = {it.episode_id: it for it in self._read()}

    @property
    def failures(self) -> tuple[Failure, ...]:
        """All, in the order in which they happened."""
        return tuple(self._failures.values())

    def add(self, failure: Failure) -> None:
        """Keep it, in place of what was kept of the same episode. Raises RecordError on a full disk."""
        self._failures.pop(failure.episode_id, None)
        self._failures[failure.episode_id] = failure
        self._write(self._failures.values())

    def drop(self, episode_id: str) -> None:
        """The episode did not fail this time."""
        if self._failures.pop(episode_id, None) is not None:
            self._write(self._failures.values())

    def _read(self) -> list[Failure]:
        if not self.path.exists():
            return []
        names = {field.name for field in fields(Failure)}
        found = []
        for number, line in enumerate(self.path.read_text(encoding="utf-8").splitlines(), start=1):
            try:
                values = json.loads(line)
                found.append(Failure(**{name: values[name] for name in names}))
            except (ValueError, KeyError, TypeError) as error:
                raise RecordError(
                    f"{self.path}, line {number}: no failure of an episode: {error!r}"
                ) from error
        return found

    def _write(self, failures: Iterable[Failure]) -> None:
        """The file is the old one or the new one, whatever happens; without failures there is none."""
        lines = "".join(json.dumps(asdict(it)) + "\n" for it in failures)
        if not lines:
            self.path.unlink(missing_ok=True)
            return
        with writing(self.path):
            write_whole(self.path, lines.encode())


@dataclass(frozen=True)
class Tolerance:
    """How many episodes of a run may fail before it stops.

    Args:
        most: A number below 1 is a share of the episodes that are to be run; from 1 on, a number of
            episodes; 0 stops at the first failure, None never.

    Raises:
        ConfigurationError: `most` is negative, or no whole number above 1.
    """

    most: float | None = 0

    def __post_init__(self) -> None:
        most = self.most
        if most is None or 0 <= most < 1 or (math.isfinite(most) and most >= 1 and most == int(most)):
            return
        raise ConfigurationError(
            f"fail_on_error={most}: must be a share below 1, a whole number of episodes, or null"
        )

    def is_passed(self, failed: int, episodes: int) -> bool:
        """Whether `failed` of so many episodes are too many."""
        if self.most is None:
            return False
        return failed > (self.most * episodes if self.most < 1 else self.most)
