"""When a newcomer first helped, from the events of hand-made episodes."""

from __future__ import annotations

import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario

from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.first_help import first_help
from adhoc.evaluation.recording import make_record
from adhoc.evaluation.trace import TraceEvent

SPOILT_BY_MATE = ("9 - replaced a", "20 mate picked_up a", "30 mate put_down a")
SPOILT_BY_ITSELF = ("9 - replaced a", "60 new picked_up a", "70 new put_down a")


def events(*told):
    """Each `step agent kind object`; an agent `-` is nobody."""
    return [
        TraceEvent(int(step), "" if agent == "-" else agent, kind.replace("_", " "), (0.0, 0.0), thing)
        for step, agent, kind, thing in (line.split() for line in told)
    ]


@pytest.mark.parametrize(
    ("told", "steps"),
    [
        ([], None),
        (["60 new picked_up a", "75 new put_down a", "75 - replaced a"], 25),
        # A teammate's work, and something put down where it does not belong, are no help.
        (["60 mate picked_up a", "75 mate put_down a", "75 - replaced a"], None),
        (["60 new picked_up a", "75 new put_down a"], None),
        (["60 new put_down b", "60 mate put_down a", "60 - replaced a"], None),
        # It drops it, and a teammate brings it home later.
        (["60 new put_down a", "70 mate picked_up a", "80 mate put_down a", "80 - replaced a"], None),
        # From a right place to a right place is none, unless somebody spoilt it meanwhile.
        (["9 - replaced a", "60 new picked_up a", "75 new put_down a", "75 - replaced a"], None),
        (
            [*SPOILT_BY_MATE, "60 new picked_up a", "75 new put_down a", "75 - replaced a"],
            25,
        ),
        (
            [*SPOILT_BY_ITSELF, "80 new picked_up a", "90 new put_down a", "90 - replaced a"],
            40,
        ),
        (["55 new put_down b", "60 new put_down a", "60 - replaced a", "70 new put_down b"], 10),
    ],
)
def test_the_first_object_from_a_wrong_place_to_a_right_one_counts(told, steps):
    assert first_help(events(*told), "new", 50) == steps


def record_of(newcomer, team=(), join_step=3, max_steps=12):
    where, mates = scenario(), list(team) or [Script(), Script()]
    result = run_episode(GridWorld(), where, Errand(), mates, newcomer, join_step, max_steps)
    conditions = Conditions(Errand(), Contender("walkers", "Walkers", lambda seat: Script()), max_steps)
    fetcher = None if newcomer is None else Contender("fetcher", "Fetcher", lambda seat: Script())
    return make_record(EpisodeKey(where, EpisodeKind(conditions, fetcher, join_step)), result, None, {}, 0.0)


def test_a_record_tells_the_newcomers_ability_and_its_first_help():
    bed, counter = fetch("knife", "bed"), [*fetch("apple", "counter"), *fetch("knife", "counter")]
    record = record_of(Script(*bed, *counter))
    assert record["newcomer"] == {
        "can_navigate": True, "can_manipulate": True, "camera_height": 1.6, "payload": 20.0, "max_steps": 100,
    }  # fmt: skip
    assert record["joined"]
    assert record["replaced"] == 2
    assert record["first_help"] == 4, "after a knife from the bed to the bed and an apple to the counter"


def test_who_did_nothing_did_not_come_or_was_not_there_has_no_first_help():
    assert record_of(Script())["first_help"] is None
    team = [Script(*fetch(thing, "counter")) for thing in ("apple", "knife")]
    late = record_of(Script(), team, join_step=11)
    assert (late["joined"], late["first_help"]) == (False, None)
    assert late["newcomer"] is not None, "what it can do is known even if it never came"
    alone = record_of(None)
    assert (alone["newcomer"], alone["first_help"]) == (None, None)
