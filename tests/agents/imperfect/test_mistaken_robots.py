from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents import communication
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.imperfect.mistaken import Mistake, MistakenPolicy
from adhoc.agents.imperfect.mistaken_task import MistakenTask
from adhoc.agents.policy import Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, Label, ObjectRecord, Pose
from adhoc.houses.facts import pickupable_categories
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.policy_contract import PolicyContract
from adhoc.testing.world_contract import contract_house
from adhoc.worlds.pybullet_world import PyBulletWorld

APPLES = [f"Apple_{number}" for number in range(300)]
IN_BED = {"room": "r", "receptacle": "Bed_0", "receptacle_category": "Bed", "is_pickupable": True}
BEDROOM = {"Bedroom": 1.0}


class Witness(Policy):
    """Keeps what it is given, and reports apples and one bed at every step."""

    def reset(self, me, capability, task, seed, ask):
        self.task, self.seen = task, []

    def confer(self, observation, inbox):
        self.conferred = observation

    def act(self, observation, inbox):
        self.seen.append(observation)
        return Turn(Action(ActionName.ROTATE_LEFT), (report(APPLES[:20]), Message(MessageKind.TEAM, "psst")))

    def respond(self, message):
        return communication.reply_message("asker", {"sub_task": None}, records(APPLES[:20]), ["r"])


def records(names):
    return [
        *(ObjectRecord(it, "Apple", (1.0, 2.0, 0.5), misplaced=True, **IN_BED) for it in names),
        ObjectRecord("Bed_0", "Bed", (5.0, 5.0, 0.5), is_receptacle=True),
    ]


def report(names):
    return communication.detection_message(records(names), ["r"])


def robot(rate, seed=0, me="robot"):
    policy = MistakenPolicy(Witness(), rate)
    policy.reset(me, Capability(), TidyingUp(), seed, lambda message: ())
    return policy


def mistakes(policy, names=APPLES):
    return {name: policy.mistake(name, "Apple") for name in names}


@pytest.fixture(scope="module")
def look():
    world = PyBulletWorld(image_size=32)
    world.reset(contract_house(), 0)
    yield world.add_agent("robot", Capability(), Pose(2.0, 2.0, 0.0, 0.5))
    world.close()


def test_so_many_objects_are_mistaken_in_all_ways():
    made = [it for it in mistakes(robot(0.5)).values() if it is not None]
    assert len(made) == pytest.approx(150, rel=0.2)
    assert {it: pytest.approx(made.count(it), rel=0.4) for it in Mistake} == dict.fromkeys(Mistake, 50)
    assert not any(mistakes(robot(0.0)).values())
    assert all(mistakes(robot(1.0)).values())


def test_every_robot_and_seed_has_mistakes_of_its_own_and_keeps_them():
    first = mistakes(robot(0.5))
    assert mistakes(robot(0.5), APPLES[::-1]) == first
    assert mistakes(robot(0.5, seed=1)) != first
    assert mistakes(robot(0.5, me="other")) != first


def test_furniture_and_robots_are_only_misplaced():
    policy = robot(1.0)
    kinds = {policy.mistake(f"thing_{number}", kind) for number in range(40) for kind in ("Bed", "Robot")}
    assert kinds == {Mistake.POSITION}


def test_it_sees_things_of_other_categories_and_always_the_same(look):
    policy = robot(1.0)
    policy.confer(look, ())
    policy.act(look, ())
    policy.act(look, ())
    seen = policy.policy.seen
    assert policy.policy.conferred is seen[0] is seen[1]
    for number, label in look.labels.items():
        is_category = policy.mistake(label.id, label.category) is Mistake.CATEGORY
        now = seen[0].labels[number]
        assert now.id == label.id
        assert (now.category != label.category) == is_category
        assert now.category == label.category or now.category in pickupable_categories()
    assert list(seen[0].labels) == list(look.labels)
    right = robot(0.0)
    right.act(look, ())
    assert right.policy.seen[0] is look


def test_labels_of_a_mistaken_category(look):
    policy = robot(1.0)
    name = next(it for it in APPLES if policy.mistake(it, "Apple") is Mistake.CATEGORY)
    told = {policy._label(Label(name, "Apple")).category for _ in range(3)}
    assert len(told) == 1
    assert told.isdisjoint({"Apple"})


def test_it_judges_some_things_the_wrong_way_round():
    policy = robot(1.0)
    for name, made in mistakes(policy).items():
        apple = ObjectRecord(name, "Apple", (0.0, 0.0, 0.0), **IN_BED)
        judged = policy.policy.task.judge(apple, BEDROOM)
        assert TidyingUp().judge(apple, BEDROOM) is True
        assert judged is (made is not Mistake.JUDGEMENT)
        assert policy.policy.task.judge(apple, {}) is None


def test_it_reports_some_things_two_metres_away(look):
    policy = robot(1.0)
    answer = policy.respond(Message(MessageKind.INTENTION, "?"))
    for told in (policy.act(look, ()).outbox[0], answer):
        for record in communication.read_objects(told):
            made = policy.mistake(record.id, record.category)
            true = (1.0, 2.0) if record.category == "Apple" else (5.0, 5.0)
            away = abs(complex(*record.position[:2]) - complex(*true))
            assert away == pytest.approx(2.0 if made is Mistake.POSITION else 0.0, abs=0.01)
            assert record.position[2] == 0.5
        assert communication.read_explored_rooms(told) == ["r"]
    assert answer.recipient == "asker"
    assert len(communication.read_objects(answer)) == 21


def test_what_is_not_a_report_is_left_alone(look):
    turn = robot(1.0).act(look, ())
    assert turn.outbox[1] == Message(MessageKind.TEAM, "psst")
    assert robot(0.0).act(look, ()).outbox[0] == report(APPLES[:20])


@given(st.integers(0, 10**6), st.text(min_size=1, max_size=30), st.sampled_from(pickupable_categories()))
def test_a_mistaken_category_is_another_one(seed, name, category):
    policy = robot(1.0, seed)
    policy.mistake(name, category)
    assert policy._categories[name] != category


class TestTask:
    def test_all_but_the_judgement_is_the_task_itself(self):
        task = TidyingUp()
        mistaken = MistakenTask(task, lambda record: True)
        assert mistaken.brief() == task.brief()
        assert mistaken.common_sense is task.common_sense
        for name in ("name", "description", "sub_tasks", "sub_skills", "fallback", "examples"):
            assert getattr(mistaken, name) == getattr(task, name)
        apple = records(["Apple_0"])[0]
        counter = ObjectRecord("Counter_0", "CounterTop", (0.0, 0.0, 0.0), is_receptacle=True)
        assert mistaken.attend(apple, [(counter, "Kitchen")]) == task.attend(apple, [(counter, "Kitchen")])
        assert mistaken.is_place_for(apple, counter, "Kitchen")
        assert mistaken.search("room|1") == task.search("room|1")

    def test_it_stays_mistaken_with_another_common_sense(self):
        mistaken = MistakenTask(TidyingUp(), lambda record: True)
        again = mistaken.with_common_sense(TidyingUp().common_sense)
        assert again.judge(records(["Apple_0"])[0], BEDROOM) is False


class TestContract(PolicyContract):
    make = staticmethod(lambda: MistakenPolicy(HeuristicPolicy(), 0.5))
