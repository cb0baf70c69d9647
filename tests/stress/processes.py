"""`adhoc run` in a process that can be killed: a new interpreter, or one that has imported everything."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from multiprocessing import get_context
from pathlib import Path
from typing import Protocol

HERE = Path(__file__).parent
IMPORTED = [
    "adhoc.cli.hydra_run",
    "adhoc.worlds.pybullet_world",
    "adhoc.agents.llm_agent",
    "adhoc.agents.heuristic",
]


class RunProcess(Protocol):
    """A run that goes on by itself."""

    def poll(self) -> int | None:
        """The exit code, if it has ended."""

    def wait(self, timeout: float | None = None) -> int:
        """The exit code."""

    def kill(self) -> None:
        """SIGKILL."""


class ForkedRun:
    """`adhoc run` in a fork of a process that has imported what takes long, but begun nothing."""

    def __init__(self, arguments: list[str], environment: Mapping[str, str], output: Path) -> None:
        context = get_context("forkserver")
        context.set_forkserver_preload(IMPORTED)
        self._process = context.Process(target=_main, args=(arguments, dict(environment), str(output)))
        self._process.start()

    def poll(self) -> int | None:
        return self._process.exitcode

    def wait(self, timeout: float | None = None) -> int:
        self._process.join(timeout)
        assert self._process.exitcode is not None
        return self._process.exitcode

    def kill(self) -> None:
        self._process.kill()


def new_run(arguments: list[str], environment: Mapping[str, str], output: Path) -> RunProcess:
    """`adhoc run` in a new interpreter."""
    command = [sys.executable, "-m", "adhoc.cli.main", *arguments]
    with open(output, "ab") as file:
        return subprocess.Popen(
            command, cwd=HERE, env={**os.environ, **environment}, stdout=file, stderr=subprocess.STDOUT
        )


def _main(arguments: list[str], environment: Mapping[str, str], output: str) -> None:
    descriptor = os.open(output, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.environ.update(environment)
    os.chdir(HERE)
    from adhoc.cli.main import main

    sys.exit(main(arguments))
