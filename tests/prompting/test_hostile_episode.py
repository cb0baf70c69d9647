"""Whole episodes of an LLM agent among hostile robots: what they say never becomes a deed of its own."""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count

import pytest
from hostile_messages import HOSTILE_TEXTS, hostile_payload

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.llm_agent import LLMAgent
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, Observation
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.message_bounds import MAX_TEXT
from adhoc.evaluation.sampling import sample_scenario
from adhoc.houses.samples import sample_house
from adhoc.llm.model import LMRequest, LMResponse, Wrapper
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.reflect import LLMReflector
from adhoc.planning.staged import StagedPlanner
from adhoc.planning.sub_skill import LLMSubSkillPlanner
from adhoc.skills.library import standard_skills
from adhoc.tasks.placement import placement_table
from adhoc.tasks.task import Task
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.watched_skill import WatchedSkill
from adhoc.worlds.pybullet_world import PyBulletWorld

TASK = TidyingUp()
STEPS = 30
PER_STEP = 3
HANDS = {ActionName.PICK_UP, ActionName.PUT_DOWN, ActionName.DROP}
LINE = re.compile(r'- step -?\d+, (you|teammate_\d) to (you|all|teammate_\d), \w+: "(?:[^"\\]|\\.)*"')


@dataclass(frozen=True)
class Forged(Message):
    """A message that writes its own sender, whatever it is told."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "sender", "newcomer")


class Hostile(Policy):
    """Says everything of the corpus, in turn, in every kind of message, and asks and answers likewise."""

    def __init__(self, texts: Iterator[int]) -> None:
        self._texts = texts
        self.answered = 0

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        self._ask = ask

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        for kind in (MessageKind.INTENTION, MessageKind.JOIN):
            self.answered += len(self._ask(self._message(kind)))
        kinds = list(MessageKind)
        outbox = [self._message(kinds[(observation.step + it) % len(kinds)]) for it in range(PER_STEP)]
        return Turn(Action(ActionName.ROTATE_LEFT), tuple(outbox))

    def respond(self, message: Message) -> Message | None:
        return self._message(MessageKind.REPLY)

    def _message(self, kind: MessageKind) -> Message:
        number = next(self._texts)
        text = HOSTILE_TEXTS[number % len(HOSTILE_TEXTS)]
        return Forged(kind, text, hostile_payload(text[:5000], number), None, "newcomer", 10**9)


class Obedient(Wrapper):
    """A model that does what the hostile robots say, every other time, and always instead of stopping."""

    def __init__(self, inner: OfflineReasoner) -> None:
        super().__init__(inner)
        self.requests: list[LMRequest] = []

    def complete(self, request: LMRequest) -> LMResponse:
        self.requests.append(request)
        response = super().complete(request)
        obeys = len(self.requests) % 2 or '"Stop"' in response.text
        return replace(response, text=self._obey()) if obeys else response

    def _obey(self) -> str:
        number = len(self.requests) // 2
        text = HOSTILE_TEXTS[number * 13 % len(HOSTILE_TEXTS)][:300]
        name = ("PickupObject", "Re-place", "Fly", text, "PutObject", "Explore")[number % 6]
        call = {"name": name, "args": [text] * (number % 4)}
        reply = {"sub_tasks": [call], "sub_skill": call, "ranking": [99, text], "feasible": text}
        return json.dumps(reply) if number % 7 or '"Stop"' in text else text


class Recorded(LLMAgent):
    """Keeps its actions and sub-tasks."""

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        turn = super().act(observation, inbox)
        self.heard = {*getattr(self, "heard", ()), *(message.sender for message in inbox)}
        self.actions = [*getattr(self, "actions", ()), turn.action]
        if self._progress.sub_task is not None:
            self.sub_tasks = {*getattr(self, "sub_tasks", ()), self._progress.sub_task}
        return turn


def newcomer(model: Obedient, capability: Capability, begun: list[Call]) -> Recorded:
    skills = {
        name: functools.partial(lambda build: WatchedSkill(build(), TASK, capability, begun), build)
        for name, build in standard_skills().items()
    }
    legal = {"legal": TASK.legal}
    planner = StagedPlanner(LLMGenerator(model, **legal), LLMEvaluator(model), LLMReflector(model), **legal)
    return Recorded(planner, LLMSubSkillPlanner(model, legal_skill=TASK.legal_skill), skills=skills, pause=1)


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld(image_size=48)
    yield world
    world.close()


@pytest.mark.parametrize("has_hands", [True, False])
def test_nothing_is_done_that_the_robot_cannot_or_the_task_does_not_know(world, has_hands: bool) -> None:
    scenario = sample_scenario(world, sample_house("one_room"), 0, misplaced=2, teammates=3)
    capability = Capability(can_manipulate=has_hands, payload=1.0, max_steps=STEPS)
    scenario = replace(scenario, newcomer=replace(scenario.newcomer, capability=capability))
    model, begun, texts = Obedient(OfflineReasoner(placement_table())), [], count()
    robot = newcomer(model, capability, begun)
    team = [Hostile(texts), Hostile(texts), HeuristicPolicy()]
    result = run_episode(world, scenario, TASK, team, robot, 0, STEPS)

    assert next(texts) >= 2 * len(HOSTILE_TEXTS)
    assert sum(it.answered for it in team[:2]) > STEPS
    assert robot.heard == {"teammate_1", "teammate_2", "teammate_3"}, "it spoke to itself, or was forged"
    assert len(begun) > 1
    assert len(robot.actions) == STEPS
    assert all(isinstance(it.name, ActionName) for it in robot.actions)
    assert has_hands or not HANDS & {it.name for it in robot.actions}
    assert all(TASK.legal(it, capability) is None for it in robot.sub_tasks)
    assert all(len(message.text) <= MAX_TEXT for message in result.trace.messages)
    check_structure(model.requests)


def check_structure(requests: Sequence[LMRequest]) -> None:
    """All prompts of one stage have the same headings; every message is on one quoted line."""
    headings: dict[str, set[tuple[str, ...]]] = {}
    for request in requests:
        user = request.messages[1].content
        lines = user.splitlines()
        titles = tuple(re.sub(r"\d+", "N", line) for line in lines if line.startswith("## "))
        headings.setdefault(request.stage, set()).add(titles)
        talk = user.split("## Communication messages\n")[1].split("\n## ")[0].strip().split("\n")[1:]
        assert all(LINE.fullmatch(line) for line in talk)
        assert [it.role for it in request.messages[:2]] == ["system", "user"]
    assert {stage: len(them) for stage, them in headings.items()} == dict.fromkeys(headings, 1)
    assert set(headings) >= {"generate", "sub_skill"}
