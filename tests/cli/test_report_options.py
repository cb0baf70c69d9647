"""What a report says of how it was made, and what of that is obeyed again."""

from __future__ import annotations

from pathlib import Path

import pytest

from adhoc.cli.report_options import asked_again, command_for, parse
from adhoc.core.errors import ConfigurationError

ASKED = [
    ["out/all"],
    ["out/all", "out/more", "--intervals", "--paper", "--family=report"],
    ["out/all", "--power", "--difference=-5.5", "--team=llm", "--policy=IRoT-LLM", "--policy=it's <-->"],
    ["out/all", "--latex=tables.tex", "--label-prefix=small", "--figures=out/figures"],
]


@pytest.mark.parametrize("arguments", ASKED)
def test_the_command_asks_for_the_same(arguments):
    options = parse(arguments)
    again = asked_again(command_for(options, "latex", Path("out/tables.tex")))
    assert again.folders == [Path(folder).name for folder in options.folders]
    assert again.figures == (None if options.figures is None else Path("figures"))
    for name, value in vars(again).items():
        if name not in ("folders", "figures"):
            assert value == getattr(options, name), name


def test_what_goes_without_saying_is_not_told_and_no_path_is():
    options = parse(["/home/somebody/out/all", "--family=table", "--intervals"])
    assert command_for(options, "markdown", Path("x.md")) == "adhoc report all --intervals"


@pytest.mark.parametrize(
    ("command", "fault"),
    [
        ("adhoc run x", "is not `adhoc report ...`"),
        ("adhoc report x --html /etc/passwd", "unrecognized arguments: --html /etc/passwd"),
        ("adhoc report x --html=/etc/passwd", "unrecognized arguments: --html=/etc/passwd"),
        ("adhoc report x --interval", "unrecognized arguments: --interval"),
        ("adhoc report x --family most", "argument --family: invalid choice: 'most'"),
        ("adhoc report 'x", "No closing quotation"),
        ("adhoc report x -h", "unrecognized arguments: -h"),
    ],
)
def test_nothing_else_is_obeyed(command, fault):
    with pytest.raises(ConfigurationError, match="adhoc report") as caught:
        asked_again(command)
    assert fault in str(caught.value)
