"""`adhoc train team`: the networks of the learned team, from nothing to checkpoints."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from adhoc.agents.learned.shipped import DECISION_FILE, DETECTOR_FILE, PREDICTOR_FILE
from adhoc.cli.dataset import whole_number
from adhoc.cli.stages import Stages
from adhoc.training.model_card import CARD_FILE
from adhoc.training.team_training import train_team
from adhoc.training.training_settings import TeamTrainingSettings

EPILOG = """\
After an interruption, the same command again: the demonstrations of each house that was done are kept in
DIR/demonstrations and not run again; everything else is made anew. Remove that folder before training with
another --placement-houses: what was demonstrated depends on it. Then

  adhoc run team=learned team.agent.checkpoints=DIR policy=none benchmark=sample
"""


def main(arguments: Sequence[str]) -> int:
    """Train, and say how right the networks are. Raises ConfigurationError for impossible arguments."""
    defaults = TeamTrainingSettings()
    parser = argparse.ArgumentParser(
        prog="adhoc train team",
        description="Train misplaced-object detector, receptacle predictor and sub-skill decision module.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--out", type=Path, default=Path("learned"), metavar="DIR", help="(learned)")
    parser.add_argument("--seed", type=int, default=defaults.seed, metavar="N", help="(%(default)s)")
    parser.add_argument(
        "--placement-houses",
        type=whole_number,
        default=defaults.placement_houses,
        metavar="N",
        help="houses whose metadata teach what belongs where (%(default)s)",
    )
    parser.add_argument(
        "--demonstration-houses",
        type=whole_number,
        default=defaults.demonstration_houses,
        metavar="N",
        help="houses in which the expert demonstrates (%(default)s)",
    )
    parser.add_argument("--workers", type=whole_number, default=2, metavar="N", help="processes (2)")
    options = parser.parse_args(list(arguments))
    settings = TeamTrainingSettings(
        seed=options.seed,
        placement_houses=options.placement_houses,
        demonstration_houses=options.demonstration_houses,
    )
    console = Console()
    started = time.monotonic()
    with Stages(console) as stages:
        cards = train_team(settings, options.out, options.workers, stages.begin)
    detector, predictor, decision = (
        cards[name]["validation"] for name in (DETECTOR_FILE, PREDICTOR_FILE, DECISION_FILE)
    )
    console.print(
        f"on validation houses: misplaced-object detector {_percent(detector['accuracy'])}, "
        f"likeliest receptacle reasonable {_percent(predictor['top_1_is_reasonable'])}, "
        f"sub-skill decisions {_percent(decision['accuracy'])}\n"
        f"{options.out / CARD_FILE}: the model card; {(time.monotonic() - started) / 60:.1f} minutes",
        soft_wrap=True,
        highlight=False,
    )
    return 0


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100 * share:.1f}%"
