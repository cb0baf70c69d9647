"""How the success of policies depends on how often the offline reasoner makes mistakes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from adhoc.core.counting import counted
from adhoc.core.errors import RecordError
from adhoc.evaluation.records import Record
from adhoc.reporting.comparisons import families
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.ordering import Place, orderings
from adhoc.reporting.results import Results

MISTAKES = ("forget_capability", "ignore_teammate", "ignore_reply")
"""The kinds of mistakes (`llm.offline.mistakes`), as the offline reasoner's parameters."""


@dataclass(frozen=True)
class Setting:
    """One rate of one kind of mistake, all others being 0; without any mistakes, `mistake` is empty."""

    mistake: str = ""
    rate: float = 0.0

    @property
    def folder(self) -> str:
        """The name of its run folder."""
        return f"{self.mistake}-{self.rate:g}" if self.mistake else "no_mistakes"

    @property
    def overrides(self) -> list[str]:
        """The configuration that has this rate, and no other mistakes."""
        rates = {kind: self.rate if kind == self.mistake else 0.0 for kind in MISTAKES}
        return ["llm=offline", *(f"llm.{kind}={rate:g}" for kind, rate in rates.items())]


@dataclass(frozen=True)
class Sensitivity:
    """The places of all policies in every setting."""

    model: str
    team: str
    join_step: int
    scenarios: int
    houses: int
    alone: float
    """Percent of scenarios that the team alone does."""
    rates: tuple[float, ...]
    """All rates, 0 first."""
    policies: tuple[str, ...]
    """In the order of their success without mistakes."""
    places: Mapping[tuple[str, float, str], Place]
    """By kind of mistake, rate and policy; rate 0 is there for every kind."""


def settings(rates: Sequence[float]) -> list[Setting]:
    """Every setting once, the one without mistakes first."""
    some = sorted({rate for rate in rates if rate > 0.0})
    return [Setting(), *(Setting(kind, rate) for kind in MISTAKES for rate in some)]


def sensitivity(records: Mapping[Setting, Sequence[Record]]) -> Sensitivity:
    """What the runs of all settings tell.

    Raises:
        RecordError: they hold no newcomers, or several teams, joining steps or models.
    """
    found = {setting: orderings(families(Results.of(mine))) for setting, mine in records.items()}
    compared = {(it.team, it.join_step) for orders in found.values() for it in orders}
    models = {it["model"] for mine in records.values() for it in mine if it["join_step"] is not None}
    if len(compared) != 1 or len(models - {None}) != 1:
        raise RecordError(
            f"one team, joining step and model are compared at several rates, not {sorted(compared)} with "
            f"{sorted(map(str, models))}; name another folder"
        )
    if any(it.get("team_model") is not None for mine in records.values() for it in mine):
        raise RecordError(
            "the team asks the model as well, whose mistakes are varied; take a team without one"
        )
    if len({len(orders) for orders in found.values()}) != 1 or Setting() not in found:
        raise RecordError("a setting has no episodes with a newcomer, or the one without mistakes is missing")
    ((team, join_step),) = compared
    base = found[Setting()][0].places
    places = {
        (kind, setting.rate, place.policy): place
        for setting, (order,) in found.items()
        for place in order.places
        for kind in ([setting.mistake] if setting.mistake else MISTAKES)
    }
    alone = [it["success"] for it in records[Setting()] if it["join_step"] is None]
    return Sensitivity(
        str(next(iter(models - {None}))),
        team,
        join_step,
        len(alone),
        len({it["house_id"] for it in records[Setting()]}),
        100.0 * sum(alone) / len(alone),
        tuple(sorted({setting.rate for setting in records})),
        tuple(place.policy for place in base),
        places,
    )


def sensitivity_markdown(found: Sensitivity) -> str:
    """A table for each kind of mistake: percent of success with its interval, by rate."""
    lines = [
        f"# Success by how often the offline reasoner errs; language model: {found.model}",
        "",
        f"Team: {found.team}, joined at step {found.join_step}; the team alone does {found.alone:.1f}% of "
        "the scenarios. %Suc, and in brackets the 95% interval of how many points it is over the team alone "
        f"(paired by scenario, bootstrap over {counted(found.houses, 'house')}, "
        f"{counted(found.scenarios, 'scenario')}).",
        "",
    ]
    for remark in few_houses([found.houses]):
        lines += [f"{remark}.", ""]
    for kind in MISTAKES:
        lines += [f"## {kind}", ""]
        lines += ["| ad hoc | " + " | ".join(f"{rate:g}" for rate in found.rates) + " |"]
        lines += ["|---|" + "---:|" * len(found.rates)]
        for policy in found.policies:
            cells = [_cell(found.places.get((kind, rate, policy))) for rate in found.rates]
            lines.append(f"| {policy} | " + " | ".join(cells) + " |")
        lines.append("")
    return "\n".join(lines)


def _cell(place: Place | None) -> str:
    if place is None:
        return "-"
    gain = place.over_alone
    bounds = f"{gain.low:+.0f}, {gain.high:+.0f}" if gain.tells_spread else "?"
    return f"{place.success.mean:.1f} [{bounds}]"
