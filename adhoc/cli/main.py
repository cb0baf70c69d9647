"""The `adhoc` command: finds the sub-command, and turns the library's errors into one clear line."""

from __future__ import annotations

import argparse
import errno
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from typing import TextIO

from adhoc import __version__
from adhoc.cli.completion import FLAGS, complete
from adhoc.core.errors import AdhocError, BudgetReached

COMMANDS = {
    "run": (
        "adhoc.cli.run",
        "run episodes: a team alone and with an ad hoc robot (Hydra overrides, -m sweeps)",
    ),
    "sensitivity": (
        "adhoc.cli.sensitivity",
        "how the order of policies depends on the offline reasoner's error rates",
    ),
    "report": ("adhoc.cli.report", "print the paper's table from the records of runs"),
    "inspect": (
        "adhoc.cli.inspect",
        "look into one episode: a page with every step and every decision, pictures, a film",
    ),
    "verify": (
        "adhoc.cli.verify",
        "check run folders: checksums, completeness, and that every number follows from the records",
    ),
    "export": ("adhoc.cli.export", "write the records of runs as CSV or Parquet"),
    "merge": ("adhoc.cli.merge", "put the shards of a run together"),
    "house": ("adhoc.cli.house", "describe a ProcTHOR house file, and draw it"),
    "dataset": ("adhoc.cli.dataset", "make, check and show datasets of houses and tasks"),
    "train": ("adhoc.cli.train", "train the learned team and other learned policies from nothing"),
    "ledger": ("adhoc.cli.ledger", "show, check, merge and redact recorded calls of language models"),
}
"""Modules are imported only when their command is used; each has `main(arguments) -> exit code`."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Troubles of a full disk, which come without the name of a file."""
RESUMABLE = ("run", "train", "sensitivity")
"""Commands that go on where they stopped."""
USAGE_ERROR = 2
OUT_OF_BUDGET = 3
READER_GONE = 141
"""As of a process that SIGPIPE ended."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `adhoc` with these arguments (of the process by default); returns the exit code.

    0 is success, 1 a run of which some episodes failed, 2 an error of the user's input (one line on stderr),
    3 a run that stopped at a cap of its budget (the same), 130 an interruption, 141 that whoever read the
    output went away, as `head` does.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    if given[:1] and given[0] in FLAGS:
        return complete(given, COMMANDS)
    command, rest = _parse(given)
    run: Callable[[Sequence[str]], int] = import_module(COMMANDS[command][0]).main
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            return run(rest)
        except BudgetReached as reached:
            sys.stderr.write(
                f"adhoc {command}: stopped: {reached}; the same command with a larger cap goes on where it "
                "stopped\n"
            )
            return OUT_OF_BUDGET
        except AdhocError as error:
            sys.stderr.write(f"adhoc {command}: error: {error}\n")
            return USAGE_ERROR
        except BrokenPipeError:
            _close_output()
            return READER_GONE
        except OSError as error:
            if error.filename is None and error.errno not in FULL:
                raise
            where = error.filename or "a file could not be written"
            sys.stderr.write(f"adhoc {command}: error: {where}: {error.strerror}\n")
            return USAGE_ERROR
        except KeyboardInterrupt:
            hint = (
                "the same command goes on where it stopped"
                if command in RESUMABLE
                else "nothing was finished"
            )
            sys.stderr.write(f"adhoc {command}: interrupted; {hint}\n")
            return 130


def _close_output() -> None:
    """What is still to be written goes nowhere, so that nothing complains of it at the end."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _parse(arguments: Sequence[str]) -> tuple[str, list[str]]:
    parser = argparse.ArgumentParser(
        prog="adhoc",
        description="Heterogeneous ad hoc teamwork: a robot that nobody briefed joins a team and helps.",
        epilog="`adhoc COMMAND --help` says more.",
    )
    parser.add_argument("--version", action="version", version=f"adhoc {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (_, description) in COMMANDS.items():
        commands.add_parser(name, help=description, add_help=False)
    chosen, rest = parser.parse_known_args(arguments[:1])
    return chosen.command, [*rest, *arguments[1:]]


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    sys.stderr.write(f"adhoc: warning: {message}\n")


if __name__ == "__main__":
    sys.exit(main())
