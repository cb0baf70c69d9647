"""The model card of the learned team as a page to read; the same facts are in the checkpoints' metadata."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from adhoc.agents.learned.shipped import DECISION_FILE, DETECTOR_FILE, PREDICTOR_FILE

CARD_FILE = "MODEL_CARD.md"

_BEGINNING = """\
# Model card: the learned team

Three small networks of the teammates with a learning-based policy (Liu et al., appendix). Made by
`adhoc train team` on generated houses; no house of a benchmark was used, neither to fit nor to choose nor to
validate. Every number below is about validation houses that took no part in the training. The same facts are
in the metadata of each file.
"""


def write_model_card(folder: Path, cards: Mapping[str, Mapping[str, Any]]) -> None:
    """Write `CARD_FILE` from the cards of the three files."""
    (folder / CARD_FILE).write_text(model_card(cards), encoding="utf-8")


def model_card(cards: Mapping[str, Mapping[str, Any]]) -> str:
    """The page as Markdown."""
    detector, predictor, decision = (cards[name] for name in (DETECTOR_FILE, PREDICTOR_FILE, DECISION_FILE))
    parts = [
        _BEGINNING,
        _settings(decision),
        "## Misplaced-object detector\n",
        "Two linear layers over the types of object, receptacle and room; says whether it is misplaced.\n",
        _facts(DETECTOR_FILE, detector),
        as_table(
            ("validation", "in place", "misplaced", "mean", "triples"),
            [
                _detector_row("all", detector["validation"]),
                _detector_row("of them not in the training", detector["validation"]["unseen"]),
            ],
        ),
        "## Reasonable-receptacle predictor\n",
        "Two linear layers over the type of the object; says which types of receptacle in which types of "
        "room are reasonable.\n",
        _facts(PREDICTOR_FILE, predictor),
        _predictor_table(predictor["validation"]),
        "## Sub-skill decision module\n",
        "Encodes own state, detections and the others, fuses them, and predicts the next kind of sub-skill. "
        "Behaviour cloning of an expert that knows the task's metadata.\n",
        _facts(DECISION_FILE, decision),
        _demonstrations(decision["data"]),
        _decision_table(decision["validation"]),
    ]
    return "\n".join(parts)


def _settings(card: Mapping[str, Any]) -> str:
    settings = ", ".join(f"{name} {value}" for name, value in sorted(card["training"].items()))
    return f"Library version {card['library_version']}. Settings: {settings}.\n"


def _facts(file: str, card: Mapping[str, Any]) -> str:
    fit = card["fit"]
    houses = ", ".join(f"{count} to {split}" for split, count in card["data"]["houses"].items())
    best = fit["best_epoch"]
    first, chosen, held_out = fit["losses"][0], fit["losses"][best], fit["held_out_losses"][best]
    return (
        f"- file: `{file}`, {card['parameters']} parameters\n"
        f"- data: {card['data']['source']}; houses: {houses}\n"
        f"- seed: {card['seed']}\n"
        f"- loss: {first:.4f} in the first epoch, {chosen:.4f} in the chosen one "
        f"({best + 1} of {len(fit['losses'])}); on the houses to choose by {held_out:.4f}\n"
    )


def _detector_row(name: str, report: Mapping[str, Any]) -> tuple[str, ...]:
    shares = (as_percent(report[field]) for field in ("in_place", "misplaced", "accuracy"))
    return (name, *shares, str(report["triples"]))


def _predictor_table(report: Mapping[str, Any]) -> str:
    cells = (as_percent(report[field]) for field in ("top_1_is_reasonable", "precision", "recall"))
    header = ("likeliest place is reasonable", "precision of all places", "recall", "objects", "types")
    return as_table(header, [(*cells, str(report["objects"]), str(report["object_types"]))])


def _demonstrations(data: Mapping[str, Any]) -> str:
    rows = [
        (
            split,
            str(data["houses"][split]),
            str(episodes),
            str(data["successful_demonstrations"][split]),
            *map(str, data["decisions_by_class"][split].values()),
        )
        for split, episodes in data["episodes"].items()
    ]
    kinds = next(iter(data["decisions_by_class"].values()))
    return as_table(("demonstrations", "houses", "episodes", "successful", *kinds), rows)


def _decision_table(report: Mapping[str, Any]) -> str:
    row = ("accuracy", as_percent(report["accuracy"]), as_percent(report["balanced_accuracy"]))
    return as_table(
        ("validation", "all decisions", "mean over classes", *report["by_class"]),
        [(*row, *map(as_percent, report["by_class"].values()))],
    )


def as_table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table; numbers to the right."""
    header = list(header)
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def as_percent(share: float | None) -> str:
    """A share with one decimal; a dash where there is none."""
    return "-" if share is None else f"{100 * share:.1f}%"
