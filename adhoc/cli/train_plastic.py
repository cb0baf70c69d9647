"""`adhoc train plastic`: PLASTIC's library of types of teams, from nothing to checkpoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.cli.training_command import add_count, train_and_tell, training_parser
from adhoc.training.model_card import as_percent
from adhoc.training.plastic_card import ONE_TYPE
from adhoc.training.plastic_settings import PlasticTrainingSettings
from adhoc.training.plastic_teams import TYPE_NAMES, team_types
from adhoc.training.plastic_training import train_plastic

EPILOG = """\
After an interruption, the same command again: the demonstrations of each house that was done are kept in
DIR/demonstrations and not run again; fits and trials begin anew. Remove that folder before training with
another --team-checkpoints: what was demonstrated depends on it. Then

  adhoc run policy=plastic policy.agent.checkpoints=DIR team=room_by_room benchmark=sample
"""


def main(arguments: Sequence[str]) -> int:
    """Train, and say how well beliefs find the type. Raises ConfigurationError for impossible arguments."""
    defaults = PlasticTrainingSettings()
    parser = training_parser(
        "plastic",
        "Train, beside each type of team, the models of its behaviour and a policy.",
        "plastic",
        defaults.seed,
        EPILOG,
    )
    parser.add_argument(
        "--type",
        action="append",
        choices=TYPE_NAMES,
        metavar="NAME",
        help=f"only this type of {', '.join(TYPE_NAMES)}; may be repeated",
    )
    add_count(parser, "--houses", defaults.houses, "houses in which the expert demonstrates beside each type")
    parser.add_argument(
        "--team-checkpoints", metavar="DIR", help="a folder that `adhoc train team` made (the shipped one)"
    )
    options = parser.parse_args(list(arguments))
    settings = PlasticTrainingSettings(
        seed=options.seed, houses=options.houses, team_checkpoints=options.team_checkpoints
    )
    types = team_types(options.type or TYPE_NAMES, options.team_checkpoints)
    train_and_tell(
        lambda begin: _found(train_plastic(settings, options.out, options.workers, begin, types)), options.out
    )
    return 0


def _found(report: Mapping[str, Any]) -> str:
    if len(report["known"]) == 1:
        return ONE_TYPE
    return (
        f"true type believed in most: {as_percent(report['found'])} of {report['episodes']} held-out "
        f"episodes, {as_percent(report['nearly_found'])} if look-alikes count as one"
    )
