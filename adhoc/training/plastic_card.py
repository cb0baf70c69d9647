"""The model card of PLASTIC's library as a page to read; the facts of a type are in its metadata too."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from adhoc.agents.learned.checkpoint import SUFFIX
from adhoc.agents.plastic.models import DECISION, HEARD, SEEN
from adhoc.training.model_card import CARD_FILE, as_percent, as_table
from adhoc.training.plastic_trials import LOOK_ALIKES

_BEGINNING = """\
# Model card: the types of teams that PLASTIC knows

One file for each type of team: two models of how its members behave (as heard, as seen), and the policy
that was learned by imitation beside such teams (Liu et al., section 'PLASTIC Policy'; Barrett et al. 2017).
Made by `adhoc train plastic` on generated houses; no house of a benchmark was used. Every accuracy below is
about houses that took no part in the training.
"""
_TRIALS = """\
## Do beliefs find the true type?

PLASTIC beside a team of each type, from the first step, in houses that took no part in the training. Rows are
the true types, columns what the team was taken for at the end of the episode. A team that has done everything
after a few steps has shown little of its type: long episodes are counted apart. The learned team imitates an
expert that divides the work as the heuristic team does, so that the two hardly differ in what they do in
public.
"""


ONE_TYPE = "one type alone: there is nothing to tell it apart from"
"""Said in place of how often beliefs found the type."""


def write_plastic_card(
    folder: Path, cards: Mapping[str, Mapping[str, Any]], report: Mapping[str, Any]
) -> None:
    """Write `model_card.CARD_FILE` from the cards of the types and the report of the trials."""
    (folder / CARD_FILE).write_text(plastic_card(cards, report), encoding="utf-8")


def plastic_card(cards: Mapping[str, Mapping[str, Any]], report: Mapping[str, Any]) -> str:
    """The page as Markdown."""
    first = next(iter(cards.values()))
    settings = ", ".join(f"{name} {value}" for name, value in first["training"].items())
    return "\n".join(
        [
            _BEGINNING,
            f"Library version {first['library_version']}. Settings: {settings}.\n",
            "## Imitation and models of behaviour\n",
            as_table(
                ("type", "file", "episodes", "decisions", "loss", "accuracy", "mean over classes"),
                [_decision_row(name, card) for name, card in cards.items()],
            ),
            as_table(
                ("type", "heard", "loss", "most likely deed", "seen", "loss", "most likely deed"),
                [
                    (name, *_behaviour_cells(card, HEARD), *_behaviour_cells(card, SEEN))
                    for name, card in cards.items()
                ],
            ),
            _TRIALS,
            _found(report),
            as_table(
                ("true type", *report["known"]),
                [(true, *map(str, taken.values())) for true, taken in report["confusion"].items()],
            ),
        ]
    )


def _found(report: Mapping[str, Any]) -> str:
    types = len(report["known"])
    if types == 1:
        return f"- {report['episodes']} episodes; {ONE_TYPE}\n"
    return (
        f"- {report['episodes']} episodes; true type believed in most: {as_percent(report['found'])} "
        f"(by chance {as_percent(1 / types)}); "
        f"mean belief in it: {as_percent(report['belief_in_true_type'])}\n"
        f"- {' and '.join(sorted(LOOK_ALIKES))} counted as one: {as_percent(report['nearly_found'])}\n"
        f"- {report['long_episodes']} episodes of {report['long']} steps or more: "
        f"{as_percent(report['found_in_long'])}, and {as_percent(report['nearly_found_in_long'])}\n"
    )


def _decision_row(name: str, card: Mapping[str, Any]) -> tuple[str, ...]:
    part = card["parts"][DECISION]
    shares = (_validated(part, field) for field in ("accuracy", "balanced_accuracy"))
    episodes, decisions = sum(card["data"]["episodes"].values()), sum(part["examples"].values())
    return (name, f"`{name}{SUFFIX}`", str(episodes), str(decisions), _loss(part), *shares)


def _behaviour_cells(card: Mapping[str, Any], part: str) -> tuple[str, ...]:
    """How many deeds, the loss on houses to choose by, and how often the likeliest deed is the true one."""
    found = card["parts"][part]
    return (str(sum(found["examples"].values())), _loss(found), _validated(found, "accuracy"))


def _loss(part: Mapping[str, Any]) -> str:
    fit = part["fit"]
    return "-" if fit is None else f"{fit['held_out_losses'][fit['best_epoch']]:.3f}"


def _validated(part: Mapping[str, Any], field: str) -> str:
    return as_percent(None if part["validation"] is None else part["validation"][field])
