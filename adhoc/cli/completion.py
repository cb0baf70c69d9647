"""Tab completion of `adhoc` and of the overrides of `adhoc run`, by Hydra's own completion.

eval "$(adhoc --shell-completion install=bash)"
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence

FLAGS = ("-sc", "--shell-completion")
_RUN = "run"


def complete(arguments: Sequence[str], commands: Iterable[str]) -> int:
    """Install completion, or answer a shell's query; returns the exit code.

    Hydra takes the first word of the line for the program and the others for overrides, so the sub-command
    is taken out. Lines of other sub-commands have no completion.

    Args:
        arguments: The flag and what Hydra takes, such as `install=bash` or `query=bash`.
        commands: Names of the sub-commands.
    """
    line = os.environ.get("COMP_LINE")
    words = (line or "").split(" ")
    if line is not None and len(words) <= 2:
        sys.stdout.write(" ".join(sorted(name for name in commands if name.startswith(words[-1]))) + "\n")
        return 0
    if line is not None:
        if words[1] != _RUN:
            return 0
        os.environ["COMP_LINE"] = " ".join([words[0], *words[2:]])
        point = os.environ.get("COMP_POINT")
        if point is not None:
            os.environ["COMP_POINT"] = str(int(point) - len(f"{_RUN} "))
    from adhoc.cli.hydra_run import run_with_hydra

    return run_with_hydra(["-sc", *arguments[1:]])
