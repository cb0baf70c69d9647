"""Where tables are printed."""

from __future__ import annotations

from rich.console import Console

PLAIN_WIDTH = 110
"""Characters of a line where there is no terminal to ask."""


def table_console() -> Console:
    """A console that is wide enough for the tables, also in files and pipes.

    Names of models, policies and teams come from configurations and records of others: none is read as
    markup.
    """
    console = Console(markup=False)
    if not console.is_terminal:
        console.width = PLAIN_WIDTH
    return console
