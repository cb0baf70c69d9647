"""Tables on a terminal: what they hold is text."""

from __future__ import annotations

from rich.table import Table

from adhoc.cli.table_console import PLAIN_WIDTH, table_console


def test_names_are_no_markup(capsys):
    table = Table("[/red] judge", title="tiny[/bold]")
    table.add_row("model[q4]")
    console = table_console()
    console.print(table)
    console.print("policy [/x]")
    out = capsys.readouterr().out
    for name in ("[/red] judge", "tiny[/bold]", "model[q4]", "policy [/x]"):
        assert name in out
    assert console.width == PLAIN_WIDTH
