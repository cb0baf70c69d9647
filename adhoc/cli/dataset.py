"""`adhoc dataset make|check|show`: making, checking and looking at datasets of houses and tasks."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module

COMMANDS = {
    "make": ("adhoc.cli.dataset_make", "make the houses and tasks of a dataset, byte for byte from a seed"),
    "check": ("adhoc.cli.dataset_check", "check a dataset, or the houses of a ProcTHOR file"),
    "ceilings": ("adhoc.cli.dataset_ceilings", "what an oracle that knows everything can do in each task"),
    "show": ("adhoc.cli.dataset_show", "describe one task, and draw it"),
}
"""Modules are imported only when their command is used; each has `main(arguments) -> exit code`."""

PLAIN_WIDTH = 110
"""Characters of a line where there is no terminal to ask."""


def main(arguments: Sequence[str]) -> int:
    """Run one of the commands; returns its exit code. Raises AdhocError for wrong input."""
    parser = argparse.ArgumentParser(
        prog="adhoc dataset",
        description="The paper's benchmark as data: houses, and tidying-up tasks in them.",
        epilog="`adhoc dataset COMMAND --help` says more.",
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (_, description) in COMMANDS.items():
        commands.add_parser(name, help=description, add_help=False)
    chosen, rest = parser.parse_known_args(list(arguments[:1]))
    run: Callable[[Sequence[str]], int] = import_module(COMMANDS[chosen.command][0]).main
    return run([*rest, *arguments[1:]])


def whole_number(text: str) -> int:
    """A command line's whole number of 1 or more."""
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number of 1 or more")
    return number
