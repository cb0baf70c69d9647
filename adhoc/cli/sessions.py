"""The provenance of all configurations of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext, suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.core.errors import AdhocError
from adhoc.experiments.provenance.session import begin_session, end_session


class Sessions:
    """Writes for each configuration what decides its episodes, and completes that at the end.

    Use as a context manager.

    Args:
        folder: The run folder; its lock is held.
        configs: Composed.
    """

    def __init__(self, folder: Path, configs: Sequence[DictConfig]) -> None:
        self._folder = folder
        self.configs: list[dict[str, Any]] = [
            {str(name): value for name, value in dict(_plain(config)).items()} for config in configs
        ]
        """The configurations as plain values."""
        self._runs: dict[int, str] = {}
        self.complete = False
        """Whether everything was done that was to be done."""

    @property
    def runs(self) -> list[str]:
        """The ids of the runs, in the order of the configurations; all have begun."""
        return [self._runs[place] for place in range(len(self.configs))]

    def begin(self, place: int, fingerprints: Mapping[str, str]) -> str:
        """Begin the session of one configuration; returns the id of its run."""
        if place not in self._runs:
            self._runs[place] = begin_session(self._folder, self.configs[place], fingerprints)
        return self._runs[place]

    def __enter__(self) -> Sessions:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for run in dict.fromkeys(self._runs.values()):
            with nullcontext() if error is None else suppress(AdhocError):
                end_session(self._folder, run, self.complete)


def _plain(config: DictConfig) -> Any:
    return OmegaConf.to_container(config, resolve=True)
