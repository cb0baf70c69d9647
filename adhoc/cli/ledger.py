"""`adhoc ledger show|verify|merge|redact`: looking at recorded model calls, and publishing them."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.cli.sub_commands import run_sub_command

COMMANDS = {
    "show": ("adhoc.cli.ledger_show", "show", "calls by stage and model, or one call in full"),
    "verify": ("adhoc.cli.ledger_verify", "verify", "check every line"),
    "merge": ("adhoc.cli.ledger_rewrite", "merge", "put ledgers together in one file"),
    "redact": (
        "adhoc.cli.ledger_rewrite",
        "redact",
        "make a file that can be published, and still be replayed",
    ),
}


def main(arguments: Sequence[str]) -> int:
    """Run one of the commands; returns its exit code. Raises AdhocError for wrong input."""
    description = "The calls of language models that runs have recorded, by default in OUT/ledger."
    return run_sub_command("adhoc ledger", description, COMMANDS, arguments)
