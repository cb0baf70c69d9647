"""What `adhoc report` can be asked for, and the command that asks for the same again."""

from __future__ import annotations

import argparse
import os.path
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn

from adhoc.cli.output_files import check_output
from adhoc.core.errors import ConfigurationError
from adhoc.reporting.comparisons import Scope
from adhoc.reporting.rendering.latex import check_label_prefix

FORMATS: Mapping[str, str] = {
    "markdown": "Markdown",
    "latex": "LaTeX (booktabs)",
    "html": "one HTML page",
}
"""The files that can be written, by the names of their options."""
EPILOG = """\
  adhoc report out/all
  adhoc report out/all --intervals --latex tables.tex --figures figures
  adhoc report out/all --paper --html report.html
  adhoc report --paper

docs/report.md explains every table and figure.
"""
_NAME = "adhoc report"


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """The options of a command. Raises ConfigurationError for options that do not fit."""
    parser = argparse.ArgumentParser(
        prog=_NAME,
        description="The paper's tables (%Suc, %PS, #TS, #AS, %SE) and figures from the records of runs.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    for name, what in FORMATS.items():
        parser.add_argument(f"--{name}", metavar="FILE", type=Path, help=f"write everything as {what}, too")
    _add_what_is_told(parser)
    options = parser.parse_args(list(arguments))
    _check(options)
    return options


def command_for(options: argparse.Namespace, form: str, file: Path) -> str:
    """The command that writes what is in `file`, of one of the `FORMATS`, again, but for where to.

    Folders are told by their names alone, since where they are is different elsewhere; that of the figures
    as it is seen from the file.
    """
    if form != "latex":
        options = argparse.Namespace(**{**vars(options), "label_prefix": ""})
    parts = [*_NAME.split(), *map(name_of, options.folders), *told(options)]
    if options.figures is not None:
        parts += ["--figures", os.path.relpath(options.figures, file.parent)]
    return " ".join(shlex.join(parts).split())


def name_of(folder: str | Path) -> str:
    """A run folder without where it is."""
    return os.path.basename(os.path.abspath(folder))


def told(options: argparse.Namespace) -> list[str]:
    """The arguments that decide what is told, without folders, and without those that go without saying."""
    parser = argparse.ArgumentParser()
    _add_what_is_told(parser)
    words = []
    for name, usual in vars(parser.parse_args([])).items():
        value = getattr(options, name)
        if name not in ("folders", "figures") and value != usual:
            option = f"--{name.replace('_', '-')}"
            values = value if isinstance(value, list) else [value]
            words += [option] if value is True else [f"{option}={one}" for one in values]
    return words


def asked_again(command: str) -> argparse.Namespace:
    """The options of `command_for`. Raises ConfigurationError for anything else, such as an option that
    writes a file."""
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise ConfigurationError(f"{command!r}: {error}") from error
    if words[:2] != _NAME.split():
        raise ConfigurationError(f"{command!r}: is not `{_NAME} ...`")
    parser = _Strict(prog=_NAME, add_help=False, allow_abbrev=False)
    _add_what_is_told(parser)
    return parser.parse_args(words[2:])


class _Strict(argparse.ArgumentParser):
    """Raises instead of leaving the process."""

    def error(self, message: str) -> NoReturn:
        raise ConfigurationError(f"{self.prog}: {message}")


def _add_what_is_told(parser: argparse.ArgumentParser) -> None:
    """Everything but the files to write."""
    parser.add_argument("folders", nargs="*", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument(
        "--label-prefix",
        metavar="NAME",
        default="",
        help="with --latex: the labels are tab:NAME-..., so that a paper can read in several reports",
    )
    parser.add_argument("--figures", metavar="DIR", type=Path, help="draw the figures there, as SVG and PNG")
    parser.add_argument(
        "--paper",
        action="store_true",
        help="the paper's own numbers below ours; without DIR the paper's alone, and what contradicts what",
    )
    parser.add_argument(
        "--intervals",
        action="store_true",
        help="an interval for each number, the order of policies by success, and who is told apart, too",
    )
    parser.add_argument(
        "--power", action="store_true", help="how many tasks it takes to tell policies apart, too"
    )
    parser.add_argument(
        "--difference",
        metavar="POINTS",
        type=float,
        help="with --power: to tell a difference of so many points of %%Suc, not the observed one",
    )
    parser.add_argument(
        "--family",
        choices=[scope.value for scope in Scope],
        default=Scope.TABLE.value,
        help="comparisons that are corrected for together: of one team at one joining step (default), or all",
    )
    for option, what in (("--team", "team"), ("--policy", "ad hoc robot")):
        parser.add_argument(
            option,
            action="append",
            metavar="NAME",
            help=f"only this {what}, by its name in the configuration or its label; may be repeated",
        )


def _check(options: argparse.Namespace) -> None:
    """What can be known to fail before any record is read."""
    if options.difference is not None and not options.power:
        raise ConfigurationError(f"--difference {options.difference:g}: goes with --power")
    if options.label_prefix and options.latex is None:
        raise ConfigurationError(f"--label-prefix {options.label_prefix}: goes with --latex")
    check_label_prefix(options.label_prefix)
    if not options.folders and not options.paper:
        raise ConfigurationError("DIR: name a run folder, or ask for the paper's numbers with --paper")
    needs_records = ("figures", "intervals", "power", "team", "policy")
    for name in () if options.folders else needs_records:
        if getattr(options, name):
            raise ConfigurationError(f"--{name}: needs a run folder; the paper gives its averages alone")
    for name in FORMATS:
        path = getattr(options, name)
        check_output(f"--{name}", path)
        if path is not None and not path.parent.is_dir():
            raise ConfigurationError(f"--{name} {path}: there is no such folder")
