"""`adhoc ledger show|verify|merge|redact`: looking at recorded model calls, and publishing them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module

COMMANDS = {
    "show": ("adhoc.cli.ledger_show", "calls by stage and model, or one call in full"),
    "verify": ("adhoc.cli.ledger_verify", "check every line"),
    "merge": ("adhoc.cli.ledger_rewrite", "put ledgers together in one file"),
    "redact": ("adhoc.cli.ledger_rewrite", "make a file that can be published, and still be replayed"),
}
"""Modules are imported only when their command is used; each has `COMMAND(arguments) -> exit code`."""


def main(arguments: Sequence[str]) -> int:
    """Run one of the commands; returns its exit code. Raises AdhocError for wrong input."""
    parser = argparse.ArgumentParser(
        prog="adhoc ledger",
        description="The calls of language models that runs have recorded, by default in OUT/ledger.",
        epilog="`adhoc ledger COMMAND --help` says more.",
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (_, description) in COMMANDS.items():
        commands.add_parser(name, help=description, add_help=False)
    chosen, rest = parser.parse_known_args(list(arguments[:1]))
    module = import_module(COMMANDS[chosen.command][0])
    run: Callable[[Sequence[str]], int] = getattr(module, chosen.command)
    return run([*rest, *arguments[1:]])
