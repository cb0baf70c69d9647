"""A few scenarios of a run with the offline reasoner, and what the whole of it would ask by them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from tempfile import TemporaryDirectory

from omegaconf import DictConfig, OmegaConf
from rich.console import Console

from adhoc.cli.comparing import comparisons_of
from adhoc.cli.model_chain import provider_model
from adhoc.evaluation.records import Record, RecordFile
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.console_progress import ConsoleProgress
from adhoc.experiments.estimate import Spread, spread_evenly, spread_of
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import run_comparison
from adhoc.llm.model import LMRequest, LMResponse, Wrapper
from adhoc.reporting.cost_table import Use, total_use

SCENARIOS = 4
"""So many scenarios of each comparison are run."""
NOTHING = Spread(Use(), Use(), Use())


@dataclass(frozen=True)
class Estimate:
    """What a run would ask."""

    episodes: int = 0
    use: Spread = NOTHING

    def __add__(self, other: Estimate) -> Estimate:
        return Estimate(self.episodes + other.episodes, self.use + other.use)


@dataclass(frozen=True)
class SampleRow:
    """What all episodes of a newcomer that joins at a step would ask, or those of the team alone."""

    label: str
    join_step: int | None
    episodes: int
    use: Use


@dataclass(frozen=True)
class Sample:
    """A comparison of which some scenarios were run."""

    comparison: Comparison
    records: Sequence[Record]
    """Of the episodes that were run; none of newcomers that ask no model in a team and task that ask none,
    and none at all if nobody asks."""
    ran: int
    """Scenarios."""
    reply_tokens: float
    """Of the whole comparison, if every reply is as long as it may be."""

    @property
    def scenarios(self) -> int:
        """Of the whole comparison."""
        return len(self.comparison.scenarios)

    @property
    def whole(self) -> Estimate:
        """With the team alone counted once for all newcomers and joining steps."""
        use = spread_of(self.records).times(self.scenarios) if self.records else NOTHING
        return Estimate(self.scenarios * len(self.comparison.kinds), use)

    @property
    def rows(self) -> list[SampleRow]:
        """The team alone, then all newcomers."""
        alone = [it for it in self.records if it["join_step"] is None]
        team = self.comparison.conditions.team.label
        found = [self._row(f"{team} alone", None, alone)]
        for it in self.comparison.entrants:
            asked = (it.newcomer.name, it.join_step)
            mine = [record for record in self.records if (record["policy"], record["join_step"]) == asked]
            found.append(self._row(it.newcomer.label, it.join_step, mine))
        return found

    def _row(self, label: str, join_step: int | None, mine: Sequence[Record]) -> SampleRow:
        use = total_use(mine).times(self.scenarios / self.ran) if mine else Use()
        return SampleRow(label, join_step, self.scenarios, use)


class _LongestReplies(Wrapper):
    """Adds up how long replies might be."""

    tokens = 0

    def complete(self, request: LMRequest) -> LMResponse:
        self.tokens += request.max_tokens
        return self._inner.complete(request)


def sample_run(configs: Sequence[DictConfig], console: Console) -> list[Sample]:
    """Run a few scenarios of every comparison of a run, in a folder that is gone afterwards.

    Args:
        configs: Those of the run, with the offline reasoner as their model.
        console: Where the progress is shown.
    """
    plain = OmegaConf.to_container(configs[0].llm, resolve=True)
    assert isinstance(plain, dict)
    longest = _LongestReplies(provider_model(configs[0], {str(name): it for name, it in plain.items()}))
    comparisons = comparisons_of(configs, lambda: longest, lambda place, _: str(place))
    try:
        return [_sample(it, longest, console) for it in comparisons]
    finally:
        comparisons.close()


def _sample(comparison: Comparison, longest: _LongestReplies, console: Console) -> Sample:
    entrants, conditions = _asking(comparison), comparison.conditions
    if not (entrants or conditions.model or conditions.team.model):
        return Sample(comparison, (), 0, 0.0)
    scenarios = comparison.scenarios
    chosen = [scenarios[position] for position in spread_evenly(len(scenarios), SCENARIOS)]
    few = replace(comparison, scenarios=chosen, entrants=entrants, artifacts=())
    longest.tokens = 0
    with TemporaryDirectory(prefix="adhoc-dry-run-") as folder, ConsoleProgress(console) as progress:
        run_comparison(few, RunFolder(folder), progress)
        records = RecordFile(folder).read()
    return Sample(comparison, records, len(chosen), longest.tokens * len(scenarios) / len(chosen))


def _asking(comparison: Comparison) -> tuple[Entrant, ...]:
    """The newcomers with which a language model is asked; in a team or task that asks one, all."""
    conditions = comparison.conditions
    if conditions.model or conditions.team.model:
        return comparison.entrants
    return tuple(it for it in comparison.entrants if it.newcomer.model)
