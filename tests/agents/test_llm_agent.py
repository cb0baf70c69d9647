"""When the LLM agent plans again, and that nothing makes it ask without bound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import pytest

from adhoc.agents.llm_agent import LLMAgent
from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Plan
from adhoc.core.values import ActionName, Capability
from adhoc.houses.samples import sample_house
from adhoc.planning.interfaces import Planner, SubSkillPlanner
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld

EXPLORE = Call("Explore", ("room|2",))


class FixedPlanner(Planner):
    """Always the same sub-task; remembers what it was shown."""

    def __init__(self, sub_task: Call) -> None:
        self.sub_task = sub_task
        self.contexts = []

    def plan(self, context, consult):
        self.contexts.append(context)
        self.consultation = consult(self.sub_task)
        return Plan(self.sub_task)


class FixedSkills(SubSkillPlanner):
    """Always the same sub-skill, or an unusable reply."""

    def __init__(self, skill: Call | None) -> None:
        self.skill = skill
        self.asked = 0

    def next_skill(self, context, sub_task, last):
        self.asked += 1
        if self.skill is None:
            raise ReplyError("nothing usable", "unreadable")
        return self.skill


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld(image_size=64)
    yield world
    world.close()


class Stage:
    """One LLM agent alone in a house; `asked` are the messages that it broadcast within steps."""

    def __init__(self, world, planner, skills, tilt=math.pi / 6, **capability) -> None:
        self.world = world
        world.reset(sample_house("one_room"), 0)
        pose = replace(world.free_poses(1, 5)[0], pitch=tilt)
        self.observation = world.add_agent("newcomer", Capability(**capability), pose)
        self.asked: list[Message] = []
        self.said: list[Message] = []
        self.told = {}
        self.agent = LLMAgent(planner, skills)
        self.agent.reset("newcomer", Capability(**capability), TidyingUp(), 0, self.ask)

    def ask(self, message: Message) -> Sequence[Message]:
        self.asked.append(message)
        told = self.told if message.kind is MessageKind.INTENTION else {}
        return [Message(MessageKind.REFLECTED, "hi", {"stopped": False, **told}, "newcomer", "teammate_1", 0)]

    def run(self, steps: int, inbox: Sequence[Message] = ()):
        actions = []
        for _ in range(steps):
            turn = self.agent.act(self.observation, inbox)
            inbox = ()
            actions.append(turn.action)
            self.said += turn.outbox
            self.observation = self.world.step({"newcomer": turn.action})["newcomer"]
        return actions


def test_it_joins_once_and_consults_before_it_acts(world):
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.run(3)
    assert [message.kind for message in stage.asked] == [MessageKind.JOIN, MessageKind.INTENTION]
    assert [mate.name for mate in planner.contexts[0].teammates] == ["teammate_1"]
    assert planner.consultation.replies[0].sender == "teammate_1"


def test_replies_are_in_the_context_at_once_and_asked_about_at_the_next_step(world):
    """A teammate answers that a fork is misplaced: the planner can judge by it, and is asked again."""
    fork = {"id": "Fork|1", "category": "Fork", "position": [1, 1, 0.5], "misplaced": True, "room": "room|2"}
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.told = {"objects": [fork], "explored_rooms": ["room|9"]}
    stage.run(1)
    known = [record.id for record in planner.consultation.context.objects if record.misplaced]
    assert known == ["Fork|1"]
    assert "Fork|1" not in [record.id for record in planner.contexts[0].objects]
    stage.run(2)
    assert len(planner.contexts) == 2


def test_its_own_messages_are_in_the_context(world):
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.run(1)
    kinds = [m.kind for m in planner.consultation.context.messages if m.sender == "newcomer"]
    assert kinds == [MessageKind.JOIN, MessageKind.INTENTION]


def test_it_tells_when_its_task_state_changes(world):
    stage = Stage(world, FixedPlanner(EXPLORE), FixedSkills(Call("Explore")))
    stage.run(1)
    (message,) = [message for message in stage.said if message.kind is MessageKind.TASK_STATE]
    assert message.payload["sub_task"] == {"name": "Explore", "args": ["room|2"]}
    assert message.payload["sub_skill"] == {"name": "Explore", "args": []}


def test_a_told_misplaced_object_makes_it_plan_again(world):
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.run(2)
    fork = {"id": "Fork|1", "category": "Fork", "position": [1, 1, 0.5], "misplaced": True}
    fork |= {"room": "room|2", "receptacle": "Sofa|2|0", "receptacle_category": "Sofa"}
    stage.run(1, [Message(MessageKind.DETECTION, "a fork", {"objects": [fork]}, None, "teammate_1", 2)])
    assert len(planner.contexts) == 2
    assert any(record.id == "Fork|1" and record.misplaced for record in planner.contexts[1].objects)


def test_a_teammate_that_stops_makes_it_plan_again(world):
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.run(2)
    stage.run(1, [Message(MessageKind.TASK_STATE, "I stop.", {"stopped": True}, None, "teammate_1", 2)])
    assert len(planner.contexts) == 2


@pytest.mark.parametrize(
    "skill", [None, Call("PickupObject", ("Pillow|2|0",)), Call("Fly"), Call("GoToObject", ("X",))]
)
def test_impossible_sub_skills_are_refused_and_asked_for_at_a_bounded_rate(world, skill):
    planner, skills = FixedPlanner(EXPLORE), FixedSkills(skill)
    stage = Stage(world, planner, skills, can_manipulate=False)
    actions = stage.run(60)
    assert {action.name for action in actions} <= {ActionName.ROTATE_RIGHT}
    assert len(planner.contexts) <= 12
    assert skills.asked <= 60


def test_it_looks_around_before_it_plans_blindly(world):
    """With the camera up it sees no floor, hence no room: the plan waits, four steps at most."""
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")), tilt=-math.pi / 6)
    actions = stage.run(6)
    assert actions[0].name is ActionName.LOOK_DOWN
    assert 0 < planner.contexts[0].step <= 4


def test_a_sub_task_that_is_over_at_once_is_not_asked_for_at_every_step(world):
    """The room has been explored, says a teammate; the planner insists on exploring it."""
    planner = FixedPlanner(EXPLORE)
    stage = Stage(world, planner, FixedSkills(Call("Explore")))
    stage.told = {"explored_rooms": ["room|2"]}
    assert {action.name for action in stage.run(60)[1:]} == {ActionName.ROTATE_RIGHT}
    assert len(planner.contexts) <= 13


def test_stopping_is_for_good(world):
    stage = Stage(world, FixedPlanner(Call("Stop")), FixedSkills(Call("Stop")))
    assert [action.name for action in stage.run(4)] == [ActionName.STOP] * 4
    assert stage.said[-1].payload["stopped"] is True


def test_an_empty_battery_stops_it(world):
    stage = Stage(world, FixedPlanner(EXPLORE), FixedSkills(Call("Explore")), max_steps=3)
    assert [action.name for action in stage.run(5)][3:] == [ActionName.STOP] * 2
