"""`adhoc dataset make|check|show`: making, checking and looking at datasets of houses and tasks."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from adhoc.cli.sub_commands import run_sub_command

COMMANDS = {
    "make": (
        "adhoc.cli.dataset_make",
        "main",
        "make the houses and tasks of a dataset, byte for byte from a seed",
    ),
    "check": ("adhoc.cli.dataset_check", "main", "check a dataset, or the houses of a ProcTHOR file"),
    "ceilings": (
        "adhoc.cli.dataset_ceilings",
        "main",
        "what an oracle that knows everything can do in each task",
    ),
    "show": ("adhoc.cli.dataset_show", "main", "describe one task, and draw it"),
}

PLAIN_WIDTH = 110
"""Characters of a line where there is no terminal to ask."""


def main(arguments: Sequence[str]) -> int:
    """Run one of the commands; returns its exit code. Raises AdhocError for wrong input."""
    description = "The paper's benchmark as data: houses, and tidying-up tasks in them."
    return run_sub_command("adhoc dataset", description, COMMANDS, arguments)


def whole_number(text: str) -> int:
    """A command line's whole number of 1 or more."""
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number of 1 or more")
    return number
