"""`adhoc train team`: the networks of the learned team, from nothing to checkpoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.agents.learned.shipped import DECISION_FILE, DETECTOR_FILE, PREDICTOR_FILE
from adhoc.cli.training_command import add_count, train_and_tell, training_parser
from adhoc.training.model_card import as_percent
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
    parser = training_parser(
        "team",
        "Train misplaced-object detector, receptacle predictor and sub-skill decision module.",
        "learned",
        defaults.seed,
        EPILOG,
    )
    add_count(
        parser,
        "--placement-houses",
        defaults.placement_houses,
        "houses whose metadata teach what belongs where",
    )
    add_count(
        parser,
        "--demonstration-houses",
        defaults.demonstration_houses,
        "houses in which the expert demonstrates",
    )
    options = parser.parse_args(list(arguments))
    settings = TeamTrainingSettings(
        seed=options.seed,
        placement_houses=options.placement_houses,
        demonstration_houses=options.demonstration_houses,
    )
    train_and_tell(
        lambda begin: _found(train_team(settings, options.out, options.workers, begin)), options.out
    )
    return 0


def _found(cards: Mapping[str, Any]) -> str:
    detector, predictor, decision = (
        cards[name]["validation"] for name in (DETECTOR_FILE, PREDICTOR_FILE, DECISION_FILE)
    )
    return (
        f"on validation houses: misplaced-object detector {as_percent(detector['accuracy'])}, "
        f"likeliest receptacle reasonable {as_percent(predictor['top_1_is_reasonable'])}, "
        f"sub-skill decisions {as_percent(decision['accuracy'])}"
    )
