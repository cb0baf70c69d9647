"""`adhoc ledger verify PATH...`: checking every line of recorded calls."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from adhoc.llm.ledger.verifying import Verdict
from adhoc.llm.ledger.verifying import verify as verify_ledger


def verify(arguments: Sequence[str]) -> int:
    """Print what is in each ledger. Raises LedgerError for the first fault."""
    parser = argparse.ArgumentParser(
        prog="adhoc ledger verify",
        description="Check every line of ledgers: checksums, fields, that all prompts are there, that every "
        "answer has a call. The first fault is told, with exit code 2.",
    )
    parser.add_argument("paths", nargs="+", metavar="PATH", help="a ledger: a folder, or one of its files")
    for path in parser.parse_args(list(arguments)).paths:
        sys.stdout.write(f"{path}: {_told(verify_ledger(path))}\n")
    return 0


def _told(verdict: Verdict) -> str:
    spending = verdict.spending
    files = "1 file" if verdict.files == 1 else f"{verdict.files} files"
    parts = [
        f"{files}, {spending.calls} calls ({spending.refused} of no use), "
        f"{spending.prompt_tokens} + {spending.completion_tokens} tokens, US$ {spending.cost_usd:.4f}",
        f"{spending.failed} failed calls",
        f"{spending.pending} never answered: they were in flight when a run was ended",
        f"{verdict.repeated} second answers to a call, of which a replay gives the first",
    ]
    counts = (1, spending.failed, spending.pending, verdict.repeated)
    return "intact; " + "; ".join(part for part, count in zip(parts, counts) if count)
