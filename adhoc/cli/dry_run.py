"""`adhoc run ... dry_run=true`: what a run would ask of its language model, without asking it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

from omegaconf import DictConfig, OmegaConf
from rich import box
from rich.console import Console
from rich.table import Table

from adhoc.cli.dry_sample import Estimate, Sample, sample_run
from adhoc.cli.model_chain import caps_of, price_of
from adhoc.cli.table_console import table_console
from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.core.resources import data_dir
from adhoc.evaluation.records import Record
from adhoc.experiments.estimate import spread_of
from adhoc.llm.prices import Price
from adhoc.reporting.cost_table import ALL_STAGES, Use, dollars, stage_rows

COLUMNS = ("of a scenario", "calls", "tokens in", "tokens out", "USD")
SWEEP_COLUMNS = ("of the whole sweep", "joins at", "episodes", *COLUMNS[1:])


def dry_runs(runs: Sequence[Sequence[DictConfig]]) -> None:
    """Print what each run would ask of its model, and in the end what all of them would.

    Args:
        runs: The configurations of each; those of one agree in what a run has once, such as the model.

    Raises:
        AdhocError: whatever does not fit, as the run would.
    """
    found = [dry_run(configs) for configs in runs]
    if len(found) > 1:
        whole = sum(found, Estimate())
        _say(table_console(), f"All {len(found)} runs: {whole.episodes:,} episodes, {_told(whole.use.mean)}.")


def dry_run(configs: Sequence[DictConfig]) -> Estimate:
    """Run a few scenarios with the offline reasoner and print what that says about the whole run.

    Configurations that differ in policy and joining step alone share the episodes of the team alone, as they
    do in the run. The run folder is not touched, and no other model is asked. Caps of an episode hold, those
    of the run are compared with the estimate. Raises AdhocError for whatever does not fit, as the run would.
    """
    llm = _plain(configs[0].llm)
    price, model = _price(llm), str(llm.get("model") or llm.get("name"))
    console = table_console()
    samples = sample_run([_offline(config, price) for config in configs], console)
    whole = sum((it.whole for it in samples), Estimate())
    asked = [it for it in samples if it.records]
    if not asked:
        labels = ", ".join(dict.fromkeys(config.policy.label for config in configs))
        _say(console, f"Dry run: {labels}: no language model is asked.")
        return whole
    if OmegaConf.is_missing(configs[0].llm, "model"):
        raise ConfigurationError("llm.model=...: must be given")
    if len(configs) == 1:
        name, what = "run", f"{configs[0].policy.label} with {model}, joining at step {configs[0].join_step}"
        table = estimate_table(samples[0].records)
    else:
        name, what, table = "sweep", f"{len(configs)} configurations with {model}", sweep_table(samples)
    _say(console, f"Dry run: {what}")
    console.print(table)
    for line in (
        f"The whole {name}: {whole.episodes:,} episodes, {_told(whole.use.mean)}. If all scenarios were like "
        f"the cheapest: {_told(whole.use.least)}; like the dearest: {_told(whole.use.most)}.",
        *_at_most(whole.use.mean, sum(it.reply_tokens for it in samples), price),
        _priced(price, model),
        f"Counted with the offline reasoner (not a language model) in {sum(it.ran for it in asked)} of "
        f"{sum(it.scenarios for it in asked)} scenarios. Prompts are those that the model would get, but a "
        "real model decides otherwise, says more in a reply, and pays for repairs: take it as an order of "
        "magnitude.",
        *_caps(configs[0], whole.use.mean),
    ):
        _say(console, line)
    return whole


def _say(console: Console, line: str) -> None:
    console.print(line, markup=False, highlight=False, soft_wrap=True)


def estimate_table(records: Sequence[Record]) -> Table:
    """What one scenario takes: every stage in the mean, all of them with their spread."""
    scenarios = len({record["task_id"] for record in records})
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in COLUMNS:
        table.add_column(column, justify="left" if column == COLUMNS[0] else "right")
    for row in stage_rows("", records):
        if row.stage != ALL_STAGES:
            table.add_row(row.stage, *_cells(row.use.times(1 / scenarios)))
    spread = spread_of(records)
    table.add_section()
    table.add_row("all, mean", *_cells(spread.mean))
    table.add_row("all, least", *_cells(spread.least))
    table.add_row("all, most", *_cells(spread.most))
    return table


def sweep_table(samples: Sequence[Sample]) -> Table:
    """What a whole sweep takes, one row for each policy and joining step, below that of its team alone."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in SWEEP_COLUMNS:
        table.add_column(column, justify="left" if column == SWEEP_COLUMNS[0] else "right")
    for sample in samples:
        for row in sample.rows:
            step = "-" if row.join_step is None else str(row.join_step)
            table.add_row(row.label, step, f"{row.episodes:,}", *_cells(row.use, digits=0))
        table.add_section()
    return table


def _at_most(mean: Use, reply_tokens: float, price: Price | None) -> Iterator[str]:
    """What it is if a model fills every reply; the offline reasoner is short of speech."""
    money = 0.0 if price is None else price.cost(round(mean.prompt_tokens), round(reply_tokens))
    if money:
        yield f"With every reply as long as it may be (max_tokens): ${dollars(money)}."


def _priced(price: Price | None, model: str) -> str:
    if price is None:
        return (
            f"The price of {model} is not known; set 'llm.price={{prompt: P, completion: C}}' in US dollars "
            "for a million tokens."
        )
    return (
        f"{model} at ${price.prompt:g} for a million prompt tokens and ${price.completion:g} for a million "
        "completion tokens, without discounts for cached prompts."
    )


def _caps(config: DictConfig, mean: Use) -> Iterator[str]:
    """Whether the run would reach its caps."""
    caps = caps_of(config, "run")
    wanted = {
        "calls": mean.calls,
        "tokens": mean.prompt_tokens + mean.completion_tokens,
        "usd": mean.cost_usd,
    }
    for unit, amount in wanted.items():
        cap = getattr(caps, unit)
        if cap is not None and amount > cap:
            yield f"budget.run.{unit}={cap} would stop the run after about {100 * cap / amount:.0f}% of it."


def _offline(config: DictConfig, price: Price | None) -> DictConfig:
    """The run with the offline reasoner at the model's price."""
    offline = OmegaConf.to_container(OmegaConf.load(data_dir("configs") / "llm" / "offline.yaml"))
    changes: dict[str, Any] = {
        "llm": {
            **(offline if isinstance(offline, dict) else {}),
            "price": None if price is None else {"prompt": price.prompt, "completion": price.completion},
        },
        "ledger": {"mode": "off"},
        "rate": {"per_minute": None},
        "budget": {"run": {"calls": None, "tokens": None, "usd": None}},
    }
    dry = config.copy()
    OmegaConf.set_struct(dry, False)
    for group, values in changes.items():
        dry[group] = values if group == "llm" else OmegaConf.merge(dry[group], values)
    return dry


def _price(llm: dict[str, Any]) -> Price | None:
    with suppress(MissingDependency):
        return price_of(llm)
    return None


def _plain(llm: Any) -> dict[str, Any]:
    plain = OmegaConf.to_container(llm, resolve=True)
    return {str(name): value for name, value in plain.items()} if isinstance(plain, dict) else {}


def _cells(use: Use, digits: int = 1) -> list[str]:
    return [
        f"{use.calls:,.{digits}f}",
        f"{use.prompt_tokens:,.0f}",
        f"{use.completion_tokens:,.0f}",
        dollars(use.cost_usd),
    ]


def _told(use: Use) -> str:
    money = f", ${dollars(use.cost_usd)}" if use.cost_usd else ""
    return (
        f"{use.calls:,.0f} calls, {use.prompt_tokens:,.0f} tokens in, {use.completion_tokens:,.0f} out{money}"
    )
