"""`adhoc run ... dry_run=true`: what a run would ask of its language model, without asking it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from tempfile import TemporaryDirectory
from typing import Any

from omegaconf import DictConfig, OmegaConf
from rich import box
from rich.table import Table

from adhoc.cli.contestants import Components
from adhoc.cli.model_chain import caps_of, price_of, provider_model
from adhoc.cli.table_console import table_console
from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.core.resources import data_dir
from adhoc.evaluation.records import Record, RecordFile
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.console_progress import ConsoleProgress
from adhoc.experiments.estimate import Spread, spread_evenly, spread_of
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import run_comparison
from adhoc.llm.model import LMRequest, LMResponse, Wrapper
from adhoc.llm.prices import Price
from adhoc.reporting.cost_table import ALL_STAGES, Use, dollars, stage_rows

SCENARIOS = 4
"""So many scenarios are run."""
COLUMNS = ("of a scenario", "calls", "tokens in", "tokens out", "USD")


def dry_run(config: DictConfig) -> None:
    """Run a few scenarios with the offline reasoner and print what that says about the whole run.

    The run folder is not touched, and no other model is asked. Caps of an episode hold, those of the run are
    compared with the estimate. Raises ConfigurationError for whatever does not fit, as the run would.
    """
    llm = _plain(config.llm)
    price, model = _price(llm), str(llm.get("model") or llm.get("name"))
    offline = _offline(config, price)
    longest = _LongestReplies(provider_model(offline, _plain(offline.llm)))
    components = Components(offline, longest)
    conditions, newcomer = components.conditions, components.newcomer
    console = table_console()
    if not any((conditions.model, conditions.team.model, newcomer and newcomer.model)):
        console.print(f"Dry run: {config.policy.label}: no language model is asked.")
        return
    if OmegaConf.is_missing(config.llm, "model"):
        raise ConfigurationError("llm.model=...: must be given")
    world = components.world
    try:
        scenarios = components.benchmark.scenarios(world, config.seed, config.limit)
        chosen = [scenarios[position] for position in spread_evenly(len(scenarios), SCENARIOS)]
        with TemporaryDirectory(prefix="adhoc-dry-run-") as folder, ConsoleProgress(console) as progress:
            entrants = () if newcomer is None else (Entrant(newcomer, config.join_step),)
            run_comparison(Comparison(world, chosen, conditions, entrants), RunFolder(folder), progress)
            records = RecordFile(folder).read()
    finally:
        world.close()
    console.print(f"Dry run: {config.policy.label} with {model}, joining at step {config.join_step}")
    console.print(estimate_table(records))
    whole, ran = spread_of(records).times(len(scenarios)), len(chosen)
    reply_tokens = longest.tokens * len(scenarios) / ran
    for line in (
        _whole_run(whole, len(scenarios)),
        *_at_most(whole.mean, reply_tokens, price),
        _priced(price, model),
        f"Counted with the offline reasoner (not a language model) in {ran} of {len(scenarios)} scenarios. "
        "Prompts are those that the model would get, but a real model decides otherwise, says more in a "
        "reply, and pays for repairs: take it as an order of magnitude.",
        *_caps(config, whole.mean),
    ):
        console.print(line, markup=False, highlight=False, soft_wrap=True)


class _LongestReplies(Wrapper):
    """Adds up how long replies might be."""

    tokens = 0

    def complete(self, request: LMRequest) -> LMResponse:
        self.tokens += request.max_tokens
        return self._inner.complete(request)


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


def _whole_run(whole: Spread, scenarios: int) -> str:
    return (
        f"The whole run, {scenarios} scenarios: {_told(whole.mean)}. If all were like the cheapest: "
        f"{_told(whole.least)}; like the dearest: {_told(whole.most)}."
    )


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


def _cells(use: Use) -> list[str]:
    return [
        f"{use.calls:,.1f}",
        f"{use.prompt_tokens:,.0f}",
        f"{use.completion_tokens:,.0f}",
        dollars(use.cost_usd),
    ]


def _told(use: Use) -> str:
    money = f", ${dollars(use.cost_usd)}" if use.cost_usd else ""
    return (
        f"{use.calls:,.0f} calls, {use.prompt_tokens:,.0f} tokens in, {use.completion_tokens:,.0f} out{money}"
    )
