"""Whole robots whose model answers badly most of the time: they go on, and do nothing that is not allowed."""

from __future__ import annotations

import functools
import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pytest
from malformed_replies import SPOILED

from adhoc.agents.llm_agent import LLMAgent
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.replies import EMPTY, TRUNCATED, UNREADABLE, Outcome
from adhoc.core.values import ActionName, Capability
from adhoc.houses.house import FLOOR
from adhoc.houses.samples import sample_house
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LMRequest, LMResponse, Wrapper
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.planning.direct import DirectPlanner
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.gpl import GPLEvaluator, GPLGenerator
from adhoc.planning.reflect import AcceptFirst, LLMReflector
from adhoc.planning.staged import StagedPlanner
from adhoc.planning.sub_skill import LLMSubSkillPlanner
from adhoc.skills.library import standard_skills
from adhoc.tasks.placement import placement_table
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.watched_skill import WatchedSkill
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.world import World

TASK = TidyingUp()
HOUSE = sample_house("one_room")
SPOILED_REPLIES = 170
"""Per kind of robot: more than 1,000 in all."""
EPISODES, STEPS = 25, 60
GOOD_EVERY = 5
KINDS = {it.value for it in Outcome} | {EMPTY, TRUNCATED, UNREADABLE}
HANDS = {ActionName.PICK_UP, ActionName.PUT_DOWN}


class Spoiling(Wrapper):
    """Spoils what the inner model answers in one way after the other, but for every fifth reply.

    Among the spoiled replies are well-formed ones that propose what needs hands.
    """

    def __init__(self, inner: OfflineReasoner) -> None:
        super().__init__(inner)
        self.replies = self.spoiled = 0
        self._turns: Counter[int] = Counter()

    def complete(self, request: LMRequest) -> LMResponse:
        response = super().complete(request)
        self.replies += 1
        if self.replies % GOOD_EVERY == 0:
            return response
        self.spoiled += 1
        return replace(response, text=self._spoil(request, response.text))

    def _spoil(self, request: LMRequest, good: str) -> str:
        way = self.spoiled % (len(SPOILED) + 1)
        self._turns[way] += 1
        schema = {} if request.reply is None else request.reply.schema
        texts = list([*(spoil(good) for spoil in SPOILED), _overreaching(schema)][way]) or [""]
        return texts[self._turns[way] * 7919 % len(texts)]


def _overreaching(schema: Mapping[str, Any]) -> Iterator[str]:
    """Every call that needs hands, well-formed and with ids from the prompt, as an answer to any stage."""
    ids = schema.get("$defs", {})
    for spec in (*TASK.sub_tasks, *TASK.sub_skills):
        if spec.needs_manipulation:
            kinds = [parameter.kind.value.replace(" ", "_") for parameter in spec.parameters]
            args = [ids.get(kind, {"enum": ["Floor"]})["enum"][0] for kind in kinds]
            call = {"name": spec.name, "args": args}
            yield json.dumps({"sub_tasks": [call], "sub_skill": call})


def robot(kind: str, model: CountingModel, capability: Capability, begun: list[Call]) -> LLMAgent:
    """A robot of one kind that asks without rest; what it begins to do is added to `begun`."""
    legal = {"legal": TASK.legal}
    gpl = GPLGenerator(model, **legal), GPLEvaluator(model), AcceptFirst()
    planners = {
        "irot": lambda: StagedPlanner(
            LLMGenerator(model, **legal), LLMEvaluator(model), LLMReflector(model), **legal
        ),
        "gpl": lambda: StagedPlanner(*gpl, **legal),
        "direct": DirectPlanner,
    }
    template = "direct_sub_skill" if kind == "direct" else "sub_skill"
    skills = {
        name: functools.partial(lambda build: WatchedSkill(build(), TASK, capability, begun), build)
        for name, build in standard_skills().items()
    }
    sub_skills = LLMSubSkillPlanner(model, template, legal_skill=TASK.legal_skill)
    return LLMAgent(planners[kind](), sub_skills, skills=skills, pause=1)


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    world = PyBulletWorld(image_size=32)
    yield world
    world.close()


def answer(message: Message) -> Sequence[Message]:
    """A teammate that there is, and that does nothing."""
    state = {"stopped": False, "sub_task": None}
    return [Message(MessageKind.REFLECTED, "I wait.", state, "newcomer", "teammate_1", 0)]


def tidy_up(world: World, agent: LLMAgent, capability: Capability, seed: int) -> None:
    """One episode in a house where everything lies on the floor, until the robot stops."""
    world.reset(HOUSE, seed)
    for thing in HOUSE.objects:
        if thing.pickupable:
            world.displace(thing.id, FLOOR, seed)
    observation = world.add_agent("newcomer", capability, world.free_poses(1, seed)[0])
    agent.reset("newcomer", capability, TASK, seed, answer)
    for _ in range(STEPS):
        action = agent.act(observation, ()).action
        assert capability.can_manipulate or action.name not in HANDS
        if action.name is ActionName.STOP:
            return
        observation = world.step({"newcomer": action})["newcomer"]


@pytest.mark.parametrize("kind", ["irot", "gpl", "direct"])
@pytest.mark.parametrize("has_hands", [True, False])
def test_a_robot_survives_its_model(world: World, kind: str, has_hands: bool) -> None:
    capability = Capability(can_manipulate=has_hands, max_steps=STEPS)
    spoiling, begun = Spoiling(OfflineReasoner(placement_table())), []
    model = CountingModel(spoiling)
    agent = robot(kind, model, capability, begun)
    for seed in range(EPISODES):
        tidy_up(world, agent, capability, seed)
        if spoiling.spoiled >= SPOILED_REPLIES:
            break
    outcomes = model.total.outcomes
    assert spoiling.spoiled >= SPOILED_REPLIES
    assert set(outcomes) <= KINDS
    assert len({call.name for call in begun}) >= 3
    assert outcomes["valid"] + 2 * outcomes["repaired"] + 2 * outcomes["invalid"] == model.total.calls
