"""Whole episodes: a heuristic team in each dialect, and the IRoT robot that joins it."""

from __future__ import annotations

import pytest

from adhoc.agents.dialects.dialect import Dialect
from adhoc.agents.dialects.known import DIALECTS
from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.dialects.structured import Silent, Structured
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.llm_agent import LLMAgent
from adhoc.core.messages import Message, MessageKind
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.sampling import sample_scenario
from adhoc.houses.samples import sample_house
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.reflect import LLMReflector
from adhoc.planning.staged import StagedPlanner
from adhoc.planning.sub_skill import LLMSubSkillPlanner
from adhoc.tasks.placement import placement_table
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld

TASK = TidyingUp()
STEPS = 40


class Martian(Dialect):
    """A format that nobody knows."""

    name = "martian"

    def write(self, message):
        return Message(message.kind, "zxq " * 5, {"zxq": [1, {"q": None}]}, message.recipient)

    def read(self, message):
        return None


SPOKEN = {**DIALECTS, Martian.name: Martian}


class Newcomer(LLMAgent):
    @property
    def known(self):
        return self._memory.teammates


def irot() -> Newcomer:
    model = OfflineReasoner(placement_table())
    planner = StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model), TASK.legal)
    return Newcomer(planner, LLMSubSkillPlanner(model))


@pytest.fixture(scope="module")
def stage():
    world = PyBulletWorld(image_size=64)
    yield world, sample_scenario(world, sample_house("one_room"), 0, misplaced=2, teammates=3)
    world.close()


def episode(stage, name: str, newcomer: Newcomer | None = None, **options):
    world, scenario = stage
    team = [Speaking(HeuristicPolicy(), SPOKEN[name]()) for _ in scenario.team]
    return run_episode(world, scenario, TASK, team, newcomer, max_steps=STEPS, **options)


@pytest.fixture(scope="module")
def alone(stage):
    return {name: episode(stage, name) for name in SPOKEN}


def deeds(result):
    return [(step.poses, step.actions) for step in result.trace.steps]


def public(result, sender: str = "") -> list[Message]:
    return [
        it for it in result.trace.messages if it.kind is not MessageKind.TEAM and sender in ("", it.sender)
    ]


def test_speaking_the_librarys_format_changes_no_byte(stage, alone) -> None:
    world, scenario = stage
    plain = run_episode(world, scenario, TASK, [HeuristicPolicy() for _ in scenario.team], max_steps=STEPS)
    assert alone["structured"].history == plain.history


@pytest.mark.parametrize("name", ["codes", "sentences"])
def test_a_team_does_the_same_in_every_dialect_that_it_understands(alone, name: str) -> None:
    assert deeds(alone[name]) == deeds(alone["structured"])
    assert alone[name].history != alone["structured"].history, "it says the same in other words"
    assert all(it.payload == {} for it in public(alone[name]))


@pytest.mark.parametrize("name", ["structured", "codes", "sentences"])
def test_a_newcomer_understands_every_message(stage, alone, name: str) -> None:
    newcomer = irot()
    result = episode(stage, name, newcomer, join_step=5, alone=alone[name].history)
    by_newcomer = len(public(result, "newcomer"))
    assert by_newcomer > 3
    assert result.not_understood == 0
    assert sum(result.understood.values()) == len(public(result))
    others = len(public(result)) - by_newcomer
    expected = {"structured": by_newcomer}
    expected[name] = expected.get(name, 0) + others
    assert result.understood == expected
    views = newcomer.known.values()
    assert len(views) == 3
    assert all(it.capability and it.position and it.sub_task for it in views)


def test_it_does_the_same_whatever_the_team_speaks(stage, alone) -> None:
    runs = [episode(stage, name, irot(), join_step=5) for name in ("structured", "codes", "sentences")]
    assert deeds(runs[0]) == deeds(runs[1]) == deeds(runs[2])


def test_nobody_hears_the_silent_and_the_episode_goes_on(stage, alone) -> None:
    newcomer = irot()
    result = episode(stage, "silent", newcomer, join_step=5, alone=alone["silent"].history)
    assert {it.sender for it in public(result)} == {"newcomer"}
    assert (set(result.understood), result.not_understood) == ({"structured"}, 0)
    assert newcomer.known == {}
    assert result.agent_steps["newcomer"] > 20
    assert len(result.trace.messages) > len(public(result)), "the team talks to itself"


def test_an_unknown_format_degrades_to_what_can_be_seen(stage, alone) -> None:
    newcomer = irot()
    result = episode(stage, "martian", newcomer, join_step=5, alone=alone["martian"].history)
    assert result.not_understood == len(public(result)) - len(public(result, "newcomer")) > 3
    assert set(result.understood) == {"structured"}
    assert len(newcomer.known) == 3, "that they are there is all it knows"
    assert not any(it.capability or it.position or it.sub_task for it in newcomer.known.values())
    assert result.agent_steps["newcomer"] > 20


@pytest.mark.parametrize("dialect", [Structured(), Silent()], ids=lambda it: it.name)
def test_a_newcomer_may_speak_a_dialect_too(stage, dialect: Dialect) -> None:
    world, scenario = stage
    team = [HeuristicPolicy() for _ in scenario.team]
    newcomer = Speaking(irot(), dialect)
    result = run_episode(world, scenario, TASK, team, newcomer, join_step=5, max_steps=20)
    assert bool(public(result, "newcomer")) == (dialect.name == "structured")
