"""`adhoc ledger merge|redact`: one new ledger file from others, which stay as they are."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from adhoc.core.errors import ConfigurationError
from adhoc.llm.ledger.redaction import Redaction
from adhoc.llm.ledger.rewriting import Rewritten, rewrite
from adhoc.llm.ledger.rewriting import merge as merge_ledgers

_IN_HELP = "a ledger: a folder, or one of its files"
_OUT_HELP = "the new file, which ends with .jsonl"


def merge(arguments: Sequence[str]) -> int:
    """Put ledgers together. Raises LedgerError for damaged inputs, and if the file exists."""
    parser = argparse.ArgumentParser(
        prog="adhoc ledger merge",
        description="Put ledgers of one model together in one file. What they hold alike is written once.",
    )
    parser.add_argument("out", metavar="OUT", help=_OUT_HELP)
    parser.add_argument("paths", nargs="+", metavar="IN", help=_IN_HELP)
    options = parser.parse_args(list(arguments))
    return _tell(options.out, merge_ledgers(options.out, options.paths))


def redact(arguments: Sequence[str]) -> int:
    """Make a ledger for others. Raises LedgerError for damaged input, and if the file exists."""
    parser = argparse.ArgumentParser(
        prog="adhoc ledger redact",
        description="Make a ledger that can be published, and still be replayed: keys of providers are never "
        "in a ledger, these options take out more.",
    )
    parser.add_argument("path", metavar="IN", help=_IN_HELP)
    parser.add_argument("out", metavar="OUT", help=_OUT_HELP)
    parser.add_argument("--prompts", action="store_true", help="leave out what the model was sent")
    parser.add_argument(
        "--raw", action="store_true", help="leave out what the provider sent beside the text of answers"
    )
    parser.add_argument("--words", type=Path, metavar="FILE", help="remove these words, one on a line")
    parser.add_argument(
        "--answers",
        action="store_true",
        help="remove words from answers, too; a replay may then miss calls that quote them",
    )
    options = parser.parse_args(list(arguments))
    words = () if options.words is None else _words(options.words)
    redaction = Redaction(options.prompts, options.raw, words, options.answers)
    return _tell(options.out, rewrite(options.out, [options.path], redaction))


def _words(path: Path) -> list[str]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"{path}: is not UTF-8 text: {error}") from error
    words = [line.strip() for line in lines if line.strip()]
    if not words:
        raise ConfigurationError(f"{path}: holds no words; write one on each line")
    return words


def _tell(out: str, rewritten: Rewritten) -> int:
    repeated = f" ({rewritten.repeated} repeated ones left out)" if rewritten.repeated else ""
    sys.stdout.write(f"{out}: {rewritten.entries - rewritten.repeated} entries{repeated}\n")
    return 0
