"""`adhoc run`: help at once, everything else by Hydra."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from adhoc.cli.run_help import help_text


def main(arguments: Sequence[str]) -> int:
    """Run with Hydra overrides; returns the exit code. Raises AdhocError for wrong input."""
    if any(argument in ("-h", "--help") for argument in arguments):
        sys.stdout.write(help_text())
        return 0
    from adhoc.cli.hydra_run import run_with_hydra

    return run_with_hydra(arguments)
