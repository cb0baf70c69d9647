"""Each scripted specialist has its one habit, and all keep the contract of policies."""

from __future__ import annotations

from adhoc import TidyingUp, run_episode
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.specialists.explore_only import ExploreOnlyPolicy
from adhoc.agents.specialists.nearest_first import NearestFirstPolicy
from adhoc.agents.specialists.room_by_room import RoomByRoomPolicy
from adhoc.core.messages import MessageKind
from adhoc.evaluation.benchmark import Draw, SampleBenchmark
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.testing.policy_contract import PolicyContract
from adhoc.worlds.pybullet_world import PyBulletWorld


class TestExploreOnly(PolicyContract):
    make = ExploreOnlyPolicy


class TestNearestFirst(PolicyContract):
    make = NearestFirstPolicy


class TestRoomByRoom(PolicyContract):
    make = RoomByRoomPolicy


def play(
    make: type[HeuristicPolicy], house: str, join: bool = False, steps: int = 200, **asked: int
) -> EpisodeResult:
    world = PyBulletWorld()
    (scenario,) = SampleBenchmark([Draw(house, **asked)]).scenarios(world, 0)
    team = [make() for _ in scenario.team]
    newcomer = HeuristicPolicy(member=False) if join else None
    result = run_episode(world, scenario, TidyingUp(), team, newcomer, 30 if join else 0, steps)
    world.close()
    return result


def claims(result: EpisodeResult) -> list[tuple[int, str, str]]:
    """Who said when that it begins to re-place which object."""
    said = [it for it in result.trace.messages if it.kind is MessageKind.TASK_STATE]
    sub_tasks = [(it, it.payload["sub_task"]) for it in said if it.payload["sub_task"] is not None]
    return [(it.step, it.sender, call["args"][0]) for it, call in sub_tasks if call["name"] == "Re-place"]


def contested(result: EpisodeResult) -> int:
    """How many claims are made on what another robot still claims."""
    current: dict[str, str | None] = {}
    count = 0
    for message in result.trace.messages:
        if message.kind is MessageKind.TASK_STATE:
            call = message.payload["sub_task"]
            claim = call["args"][0] if call is not None and call["name"] == "Re-place" else None
            others = [was for name, was in current.items() if name != message.sender]
            count += claim is not None and claim in others
            current[message.sender] = claim
    return count


def test_explorers_only_explore():
    result = play(ExploreOnlyPolicy, "one_room", seed=0, misplaced=2, teammates=3)
    able = [member for member in result.scenario.team if member.capability.can_manipulate]
    assert able
    assert not [event for event in result.trace.events if event.kind == "picked up"]
    assert result.ending.name == "STOPPED"
    told = [it for message in result.trace.messages for it in message.payload.get("objects", ())]
    assert any(it["misplaced"] for it in told)


def test_nearest_first_robots_run_for_the_same_object():
    asked = {"seed": 0, "misplaced": 3, "teammates": 5}
    assert contested(play(NearestFirstPolicy, "one_room", **asked)) > 0
    assert contested(play(HeuristicPolicy, "one_room", **asked)) == 0


def early(result: EpisodeResult) -> int:
    """How many claims are made on an object in a room that nobody had explored yet."""
    explored: set[str] = set()
    room_of: dict[str, str] = {}
    count = 0
    for message in result.trace.messages:
        call = message.payload.get("sub_task")
        if message.kind is MessageKind.TASK_STATE and call is not None and call["name"] == "Re-place":
            count += room_of[call["args"][0]] not in explored
        if message.kind is MessageKind.DETECTION:
            explored |= set(message.payload["explored_rooms"])
            room_of.update((entry["id"], entry["room"]) for entry in message.payload["objects"])
    return count


def test_room_by_room_an_object_waits_until_its_room_is_explored():
    asked = {"seed": 0, "misplaced": 3, "teammates": 3}
    patient, eager = (play(make, "corridor", **asked) for make in (RoomByRoomPolicy, HeuristicPolicy))
    assert claims(patient)
    assert early(patient) == 0
    assert early(eager) > 0


def test_a_newcomer_changes_nothing_before_it_joins():
    for make in (ExploreOnlyPolicy, NearestFirstPolicy, RoomByRoomPolicy):
        asked = {"seed": 1, "misplaced": 2, "teammates": 3}
        alone, together = (play(make, "corridor", join, 40, **asked) for join in (False, True))
        shared = min(len(alone.history), 31)
        assert alone.history[:shared] == together.history[:shared]
        assert together.joined
