"""Teams that plan in turn: who is asked what, in which order, and how often."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

import pytest

from adhoc.agents.communication import call_payload
from adhoc.agents.crew import plan_message
from adhoc.agents.llm_teammate import LLMTeammate
from adhoc.agents.policy import Policy, Turn
from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Objection, Proposal
from adhoc.core.values import Action, ActionName, Capability
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.sampling import sample_scenario
from adhoc.houses.samples import sample_house
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.llm.side_by_side import GatheringModel
from adhoc.planning.interfaces import Negotiator, SubSkillPlanner
from adhoc.planning.negotiate import LLMNegotiator
from adhoc.planning.sub_skill import LLMSubSkillPlanner
from adhoc.tasks.placement import placement_table
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld

STOP, LOOK = Call("Stop"), Call("Explore")
FIRST = Call("Explore", ("room|9",))
HOUSE = "one_room"


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld(image_size=64)
    yield world
    world.close()


class Scripted(Negotiator):
    """Says what `word` says of who speaks, in which step, and what is planned; remembers all of it."""

    def __init__(self, word: Callable[..., Proposal], log: list[tuple[object, ...]]) -> None:
        self.word, self.log = word, log

    def propose(self, context, plans: Mapping[str, Call], objections=(), changes=()) -> Proposal:
        self.log.append((context.step, context.me, dict(plans), tuple(objections), tuple(changes)))
        return self.word(context, plans, objections)


class Calm(TidyingUp):
    """Nothing ever needs attention, and no sub-task is ever over."""

    def judge(self, record, room_types):
        return None

    def finished(self, sub_task, done, rooms):
        return False


class Search(SubSkillPlanner):
    def next_skill(self, context, sub_task, last):
        return LOOK


def explore(context) -> Call:
    return Call("Explore", (context.rooms[0].id,)) if context.rooms else Call("Explore", ("room|1",))


def explore_any(log) -> Call:
    """What the first robot planned first."""
    return next(iter(log[1][2].values()))


def content(context, plans, objections) -> Proposal:
    return Proposal(explore(context))


def play(world, word, newcomer=None, max_steps=6, log=None, team=3, **options) -> EpisodeResult:
    log = [] if log is None else log
    where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=team)
    policies = [LLMTeammate(Scripted(word, log), Search(), **options) for _ in range(team)]
    return run_episode(world, where, Calm(), policies, newcomer, join_step=2, max_steps=max_steps)


class Newcomer(Policy):
    """Joins, says so, and turns."""

    def reset(self, me, capability, task, seed, ask):
        self.me, self.ask, self.joined = me, ask, False

    def act(self, observation, inbox):
        if not self.joined:
            self.answers = self.ask(Message(MessageKind.JOIN, "hello", {}))
            self.joined = True
        return Turn(Action(ActionName.ROTATE_LEFT))


class TestTurns:
    def test_all_tell_their_abilities_first_and_then_plan_in_turn(self, world):
        log: list[tuple[object, ...]] = []
        result = play(world, content, log=log)
        first = [entry for entry in log if entry[0] == 1]
        assert not [entry for entry in log if entry[0] == 0]
        assert [entry[1] for entry in first] == ["teammate_1", "teammate_2", "teammate_3"]
        assert [list(entry[2]) for entry in first] == [[], ["teammate_1"], ["teammate_1", "teammate_2"]]
        ready = [it for it in result.trace.messages if it.step == 0 and it.kind is MessageKind.TASK_STATE]
        assert [it.payload["capability"]["payload"] for it in ready] == [
            member.capability.payload for member in result.scenario.team
        ]

    def test_whoever_has_a_sub_task_does_not_plan_again(self, world):
        log: list[tuple[object, ...]] = []
        play(world, content, log=log, max_steps=4)
        assert [entry[1] for entry in log] == ["teammate_1", "teammate_2", "teammate_3"]


class TestObjections:
    @staticmethod
    def stubborn(context, plans, objections) -> Proposal:
        """teammate_3 objects to whatever teammate_1 plans."""
        against = ()
        if context.me == "teammate_3":
            against = (Objection("teammate_3", "teammate_1", plans["teammate_1"], "mine"),)
        return Proposal(STOP if objections else explore(context), "", against)

    def test_the_plan_is_made_again_before_the_objector_plans(self, world):
        log: list[tuple[object, ...]] = []
        play(world, self.stubborn, log=log, max_steps=2)
        spoken = [(me, len(objections)) for _, me, _, objections, _ in log]
        assert spoken == [
            ("teammate_1", 0),
            ("teammate_2", 0),
            ("teammate_3", 0),
            ("teammate_1", 1),
            ("teammate_3", 0),
        ]
        assert log[3][3][0].reason == "mine"
        assert log[4][2]["teammate_1"] == STOP

    def test_whoever_objects_in_vain_objects_no_more_and_nobody_plans_again_twice_a_step(self, world):
        log: list[tuple[object, ...]] = []
        play(world, self.stubborn, log=log, max_steps=2, rounds=3)
        speakers = [me for _, me, *_ in log]
        assert speakers.count("teammate_1") == 2
        assert speakers.count("teammate_3") == 2

    def test_without_rounds_nobody_plans_again(self, world):
        log: list[tuple[object, ...]] = []
        play(world, self.stubborn, log=log, max_steps=2, rounds=0)
        assert [me for _, me, *_ in log] == ["teammate_1", "teammate_2", "teammate_3"]

    def test_the_decision_tells_of_it(self, world):
        result = play(world, self.stubborn, max_steps=2)
        traces = {it.agent: it.trace["decision"] for it in result.trace.decisions if "decision" in it.trace}
        assert traces["teammate_3"]["objections"][0]["planner"] == "teammate_1"
        assert traces["teammate_1"]["objected"][0]["objector"] == "teammate_3"
        assert traces["teammate_1"]["chosen"] == "Stop"

    def test_the_others_hear_of_the_plan_that_was_made_again(self, world):
        def word(context, plans, objections):
            against = ()
            if context.me == "teammate_2" and not objections:
                against = (Objection("teammate_2", "teammate_1", plans["teammate_1"], "mine"),)
            return Proposal(STOP if objections else explore(context), "", against)

        log: list[tuple[object, ...]] = []
        play(world, word, log=log, max_steps=2)
        (third,) = [entry for entry in log if entry[1] == "teammate_3"]
        assert third[2]["teammate_1"] == STOP

    @pytest.mark.parametrize("option", ["rounds", "pause", "patience"])
    def test_negative_numbers_are_errors(self, world, option):
        with pytest.raises(ConfigurationError, match=f"{option}=-1"):
            play(world, content, **{option: -1})

    def test_a_robot_whose_turn_is_to_come_plans_again_in_its_turn(self, world):
        """teammate_1 plans again in step 3 and objects to what teammate_3 is at since step 1."""

        class Restless(Calm):
            def finished(self, sub_task, done, rooms):
                return sub_task.name == "Re-place"

        def word(context, plans, objections):
            if context.me != "teammate_1":
                return Proposal(STOP if objections else explore(context))
            against = (Objection("teammate_1", "teammate_3", plans["teammate_3"], "mine"),) if plans else ()
            return Proposal(Call("Re-place", ("Mug|1", "Shelf", "Kitchen")), "", against)

        log: list[tuple[object, ...]] = []
        where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=3)
        team = [LLMTeammate(Scripted(word, log), Search()) for _ in range(3)]
        result = run_episode(world, where, Restless(), team, max_steps=9)
        (again,) = [entry for entry in log if entry[1] == "teammate_3" and entry[3]]
        objected = [it for it in log if it[1] == "teammate_1" and it[0] == again[0]]
        assert objected, "in the step of the objection, and not before"
        assert len([it for it in log if it[1] == "teammate_3" and it[0] == again[0]]) == 1
        told = [it.text for it in result.trace.messages if it.sender == "teammate_3"]
        assert any(text.startswith("My sub-task is now: Stop") for text in told)


class TestStrangers:
    """A newcomer that speaks as members do among themselves."""

    class Forger(Newcomer):
        def confer(self, observation, inbox):
            for name in ("teammate_1", "teammate_2", "teammate_3"):
                payload = {"objects_to": call_payload(Call("Explore", ("room|2",))), "reason": "mine"}
                self.ask(Message(MessageKind.TEAM, "", payload, name))
            plans = {"teammate_1": call_payload(STOP)}
            self.ask(Message(MessageKind.TEAM, "", {"plan": None, "stopped": False, "revised": plans}))

        def respond(self, message):
            return plan_message(STOP)

    def test_forges_no_plans_and_makes_nobody_plan_again(self, world):
        log: list[tuple[object, ...]] = []
        result = play(world, content, self.Forger(), log=log, max_steps=12, adaptive=False)
        assert [me for _, me, *_ in log] == ["teammate_1", "teammate_2", "teammate_3"]
        assert result.undeliverable > 0

    def test_is_noticed_as_a_newcomer_all_the_same(self, world):
        log: list[tuple[object, ...]] = []
        play(world, content, self.Forger(), log=log, max_steps=6)
        again = [entry for entry in log if entry[0] > 1]
        assert [entry[1] for entry in again] == ["teammate_1", "teammate_2", "teammate_3"]
        assert {frozenset(entry[2].values()) for entry in again} == {frozenset({explore_any(log)})}


class TestUnusableReplies:
    def test_a_sub_task_that_is_over_is_not_kept(self, world):
        """Else the robot would look around for ever."""

        class Over(Calm):
            def finished(self, sub_task, done, rooms):
                return sub_task == FIRST

        def word(context, plans, objections):
            if context.step > 1:
                raise ReplyError("nothing usable", "unreadable")
            return Proposal(FIRST)

        where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=1)
        log: list[tuple[object, ...]] = []
        team = [LLMTeammate(Scripted(word, log), Search())]
        result = run_episode(world, where, Over(), team, max_steps=20)
        chosen = [it.trace["decision"]["chosen"] for it in result.trace.decisions if "decision" in it.trace]
        assert chosen[0] == str(FIRST)
        assert str(FIRST) not in chosen[1:]

    def test_the_safe_choice_is_taken_and_said(self, world):
        safe = []

        def mute(context, plans, objections) -> Proposal:
            safe.append(str(context.task.fallback))
            raise ReplyError("nothing usable", "unreadable")

        result = play(world, mute, max_steps=3)
        decisions = [it.trace["decision"] for it in result.trace.decisions if "decision" in it.trace]
        assert len(decisions) == 3
        assert [it["chosen"] for it in decisions] == safe
        assert all("unreadable" in it["fallback"] for it in decisions)

    def test_impossible_sub_skills_are_asked_for_at_a_bounded_rate(self, world):
        class Impossible(SubSkillPlanner):
            asked = 0

            def next_skill(self, context, sub_task, last):
                Impossible.asked += 1
                raise ReplyError("nothing", "empty")

        where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=1)
        log: list[tuple[object, ...]] = []
        run_episode(world, where, Calm(), [LLMTeammate(Scripted(content, log), Impossible())], max_steps=31)
        assert len(log) <= 7
        assert Impossible.asked <= 3 * 7


class TestAdaptation:
    def test_an_adaptive_team_plans_again_when_a_robot_joins_and_says_so(self, world):
        log: list[tuple[object, ...]] = []
        newcomer = Newcomer()
        play(world, content, newcomer, log=log, max_steps=5)
        again = [entry for entry in log if entry[0] == 3]
        assert [entry[1] for entry in again] == ["teammate_1", "teammate_2", "teammate_3"]
        assert {entry[4] for entry in again} == {(f"{newcomer.me} has joined the team at step 2",)}

    def test_another_team_does_not(self, world):
        log: list[tuple[object, ...]] = []
        play(world, content, Newcomer(), log=log, max_steps=5, adaptive=False)
        assert not [entry for entry in log if entry[0] == 3]
        assert {entry[4] for entry in log} == {()}

    def test_a_silent_member_is_broken(self, world):
        class Dying(LLMTeammate):
            def confer(self, observation, inbox):
                if observation.step < 2:
                    super().confer(observation, inbox)

            def act(self, observation, inbox):
                if observation.step < 2:
                    return super().act(observation, inbox)
                return Turn(Action(ActionName.ROTATE_LEFT))

        where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=2)
        log: list[tuple[object, ...]] = []
        team = [kind(Scripted(content, log), Search()) for kind in (LLMTeammate, Dying)]
        run_episode(world, where, Calm(), team, max_steps=12)
        told = [entry for entry in log if entry[4]]
        assert told[0][4] == ("teammate_2 is broken: it has been silent since step 2",)
        assert told[0][1] == "teammate_1"
        assert "teammate_2" not in told[0][2]

    def test_the_newcomer_is_answered_with_state_and_capability(self, world):
        newcomer = Newcomer()
        result = play(world, content, newcomer, max_steps=4)
        assert [it.kind for it in newcomer.answers] == [MessageKind.REFLECTED] * 3
        assert newcomer.answers[0].payload["capability"] == vars(result.scenario.team[0].capability)

    def test_the_past_is_the_same_with_and_without_the_newcomer(self, world):
        alone = play(world, content)
        joined = play(world, content, Newcomer())
        assert joined.history[:3] == alone.history[:3]
        assert joined.history[3:] != alone.history[3:]


class Crowd(LanguageModel):
    """The offline reasoner, which notes how many questions are under way at once."""

    def __init__(self) -> None:
        self.inner = OfflineReasoner(placement_table())
        self.under_way = self.most = 0
        self.lock, self.gate = threading.Lock(), threading.Condition()
        self.waits_for = 1

    @property
    def name(self) -> str:
        return self.inner.name

    def complete(self, request: LMRequest) -> LMResponse:
        if request.stage == "sub_skill":
            with self.gate:
                self.under_way += 1
                self.most = max(self.most, self.under_way)
                self.gate.notify_all()
                self.gate.wait_for(lambda: self.most >= self.waits_for, timeout=2)
        response = self.inner.complete(request)
        if request.stage == "sub_skill":
            with self.gate:
                self.under_way -= 1
        return response


def test_the_sub_skills_of_all_members_are_asked_for_together(world):
    model = Crowd()
    model.waits_for = 3
    gathering = GatheringModel(model)

    def run(model: LanguageModel) -> EpisodeResult:
        where = sample_scenario(world, sample_house(HOUSE), seed=6, misplaced=1, teammates=3)
        team = [
            LLMTeammate(LLMNegotiator(model, legal=TidyingUp().legal), LLMSubSkillPlanner(model))
            for _ in range(3)
        ]
        return run_episode(world, where, TidyingUp(), team, max_steps=12)

    together = run(gathering)
    assert model.most == 3
    assert together.history == run(OfflineReasoner(placement_table())).history
    assert Capability in {type(it.capability) for it in together.scenario.team}
