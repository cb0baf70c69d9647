"""`adhoc ledger show PATH`: calls by stage and model, or one call in full."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from itertools import islice

from rich.console import Console
from rich.table import Table

from adhoc.cli.dataset import PLAIN_WIDTH
from adhoc.llm.ledger.entry import Answer, Failure, Text
from adhoc.llm.ledger.spending import Spending
from adhoc.llm.ledger.summary import Exchange, Summary, exchanges, find_call, texts_of_file

MOST_LISTED = 40
KEY_SHOWN = 12


def show(arguments: Sequence[str]) -> int:
    """Print the table, or the call. Raises LedgerError if there is no ledger, or it is damaged."""
    parser = argparse.ArgumentParser(
        prog="adhoc ledger show", description="What a ledger of model calls holds, by stage and model."
    )
    parser.add_argument("path", metavar="PATH", help="a ledger: a folder, or one of its files")
    parser.add_argument("--stage", help="list the calls of one stage, e.g. generate")
    parser.add_argument("--episode", metavar="ID", help="list the calls that one episode asked first")
    parser.add_argument("--call", metavar="KEY", help="one call in full; the beginning of its key is enough")
    options = parser.parse_args(list(arguments))
    console = Console(highlight=False, markup=False)
    if not console.is_terminal:
        console.width = PLAIN_WIDTH
    if options.call is not None:
        _show_call(find_call(options.path, options.call), console)
        return 0
    summary = Summary()
    for exchange in exchanges(options.path, options.stage, options.episode):
        summary.add(exchange)
    console.print(_table(summary))
    if options.stage is not None or options.episode is not None:
        _list_calls(
            "calls",
            list(islice(exchanges(options.path, options.stage, options.episode), MOST_LISTED)),
            console,
        )
    elif summary.pending:
        _list_calls("pending: in flight when a run was ended", summary.pending[:MOST_LISTED], console)
    return 0


def _table(summary: Summary) -> Table:
    table = Table("stage", "model", title="calls")
    for name in ("calls", "no use", "failed", "pending", "prompt tokens", "reply tokens", "US$"):
        table.add_column(name, justify="right")
    for (stage, model), spending in sorted(summary.groups.items()):
        table.add_row(stage, model, *_figures(spending))
    table.add_section()
    table.add_row("all", "", *_figures(summary.total))
    return table


def _figures(spending: Spending) -> list[str]:
    counts = (spending.calls, spending.refused, spending.failed, spending.pending)
    tokens = (spending.prompt_tokens, spending.completion_tokens)
    return [*map(str, counts), *map(str, tokens), f"{spending.cost_usd:.4f}"]


def _list_calls(title: str, found: Sequence[Exchange], console: Console) -> None:
    table = Table(title=title)
    for name in ("key", "stage", "agent", "episode", "what became of it", "tokens"):
        table.add_column(name, overflow="fold")
    for exchange in found:
        call, answer = exchange.call, exchange.ending
        tokens = f"{answer.prompt_tokens} + {answer.completion_tokens}" if isinstance(answer, Answer) else ""
        table.add_row(call.key[:KEY_SHOWN], call.stage, call.agent, call.episode, exchange.fate, tokens)
    console.print(table)
    if len(found) == MOST_LISTED:
        console.print(f"the first {MOST_LISTED}; --stage and --episode choose others")


def _show_call(exchange: Exchange, console: Console) -> None:
    call, texts = exchange.call, texts_of_file(exchange.file)
    facts = {
        "key": call.key,
        "file": exchange.file,
        "asked": f"{call.time} in stage {call.stage} by {call.agent or '-'} in episode {call.episode or '-'}",
        "request": f"model {call.model}, temperature {call.temperature}, seed {call.seed}, "
        f"at most {call.max_tokens} tokens, sample {call.sample}, repeat {call.repeat}",
        "template": call.template or "-",
    }
    _print_facts(facts, console)
    if call.schema is not None:
        _print_text("schema", texts.get(call.schema), console)
    for role, digest in call.messages:
        _print_text(role, texts.get(digest), console)
    _show_ending(exchange, console)


def _show_ending(exchange: Exchange, console: Console) -> None:
    ending = exchange.ending
    if ending is None:
        _print_facts({"ended": "pending: in flight when the run was ended"}, console)
    elif isinstance(ending, Failure):
        _print_facts({"failed": f"{ending.time} {ending.error}: {ending.message}"}, console)
    else:
        _print_facts(
            {"answered": f"{ending.time} by {ending.model or '-'} after {ending.latency_s:g} s"}, console
        )
        used = f"{ending.prompt_tokens} + {ending.completion_tokens} tokens, US$ {ending.cost_usd:.6f}"
        _print_facts({"used": used, "finished": ending.finish_reason}, console)
        if ending.outcome is not None:
            _print_facts({"no use": f"{ending.outcome}: {ending.problem}"}, console)
        console.rule("answer", align="left")
        console.print(ending.text, soft_wrap=True)
        if ending.raw is not None:
            console.rule("raw", align="left")
            console.print(json.dumps(ending.raw, indent=2), soft_wrap=True)


def _print_facts(facts: dict[str, object], console: Console) -> None:
    for name, value in facts.items():
        console.print(f"{name + ':':10} {value}", soft_wrap=True)


def _print_text(title: str, text: Text | None, console: Console) -> None:
    is_whole = text is not None and not text.redacted
    console.rule(title if is_whole else f"{title} (redacted)", align="left")
    console.print("" if text is None else text.content, soft_wrap=True)
