"""`adhoc train team|plastic`: training what is learned from nothing."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.cli.sub_commands import run_sub_command

COMMANDS = {
    "team": ("adhoc.cli.train_team", "main", "train the learned team: demonstrations and all"),
    "plastic": (
        "adhoc.cli.train_plastic",
        "main",
        "train PLASTIC: what each type of team does, and what to do beside it",
    ),
}


def main(arguments: Sequence[str]) -> int:
    """Run one of the commands; returns its exit code. Raises AdhocError for wrong input."""
    description = "Train what is learned, from houses that no benchmark has. Needs torch (adhoc[learned])."
    return run_sub_command("adhoc train", description, COMMANDS, arguments)
