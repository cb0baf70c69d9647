"""A command that has commands of its own, such as `adhoc dataset check`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module

SubCommand = tuple[str, str, str]
"""The module, its function `(arguments) -> exit code`, and a line of help."""


def run_sub_command(
    prog: str, description: str, commands: Mapping[str, SubCommand], arguments: Sequence[str]
) -> int:
    """Run the command that the first argument names, with the other arguments; returns its exit code.

    Modules are imported only when their command is used. Raises what the command raises.
    """
    parser = argparse.ArgumentParser(
        prog=prog, description=description, epilog=f"`{prog} COMMAND --help` says more."
    )
    parsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (_, _, told) in commands.items():
        parsers.add_parser(name, help=told, add_help=False)
    chosen, rest = parser.parse_known_args(list(arguments[:1]))
    module, function, _ = commands[chosen.command]
    run: Callable[[Sequence[str]], int] = getattr(import_module(module), function)
    return run([*rest, *arguments[1:]])
