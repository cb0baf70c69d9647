"""One episode: the team alone, or the team and a newcomer that joins at some step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby

from adhoc.agents.policy import Policy, Turn
from adhoc.core.errors import BudgetReached, ConfigurationError, EpisodeError
from adhoc.core.values import Action, Observation, Pose
from adhoc.evaluation.channel import Channel
from adhoc.evaluation.episode_result import Ending, EpisodeResult
from adhoc.evaluation.failing import Failing
from adhoc.evaluation.history import History, check_shared_past
from adhoc.evaluation.imperfections import PERFECT, Imperfections
from adhoc.evaluation.joining import joining_pose
from adhoc.evaluation.observer import BLIND, EpisodeObserver
from adhoc.evaluation.referee import PlacementReferee, RefereeMaker
from adhoc.evaluation.scenario import Member, Scenario, prepare
from adhoc.evaluation.trace import Trace
from adhoc.evaluation.understanding import Understanding
from adhoc.llm.side_by_side import side_by_side
from adhoc.tasks.task import Task
from adhoc.worlds.world import AgentTruth, World


def run_episode(
    world: World,
    scenario: Scenario,
    task: Task,
    team: Sequence[Policy],
    newcomer: Policy | None = None,
    join_step: int = 0,
    max_steps: int = 500,
    referee: RefereeMaker = PlacementReferee,
    alone: Sequence[str] | None = None,
    imperfections: Imperfections = PERFECT,
    observer: EpisodeObserver = BLIND,
) -> EpisodeResult:
    """Run one episode from set-up to its end; deterministic if the policies are.

    The teammates act in the order of `scenario.team`, the newcomer after them. It enters before the
    robots look at step `join_step`. The episode ends when the referee sees every misplaced object in a
    right place, when every robot present has stopped or is out of battery or order, after `max_steps` steps,
    or in the step in which a robot asks a language model more than a budget allows.

    Args:
        world: Any world; it is reset.
        scenario: What is set up.
        task: What the policies are told to do.
        team: One policy for each teammate, in order.
        newcomer: The policy of the ad hoc robot; None runs the team alone.
        join_step: When it joins, at least 0 and below `max_steps`.
        max_steps: The step limit (500 in the paper).
        referee: Watches the ground truth and says when the task is done; another task brings its own.
        alone: The `history` of the team alone in the same scenario. If given, the past up to the joining
            step is checked against it.
        imperfections: What is wrong with the team and the radio.
        observer: Is shown every step, and changes nothing.

    Raises:
        ConfigurationError: The number of policies or the joining step does not fit.
        EpisodeError: The past differs from `alone`, or a policy broke the rules of the channel.
        HouseError, WorldError: The scenario cannot be set up.
    """
    if len(team) != len(scenario.team):
        raise ConfigurationError(
            f"scenario {scenario.id!r} has {len(scenario.team)} teammates, not {len(team)}"
        )
    if newcomer is not None and not 0 <= join_step < max_steps:
        raise ConfigurationError(f"join_step={join_step}: must be at least 0 and below max_steps={max_steps}")
    task.begin_episode()
    episode = _Episode(world, scenario, task, referee, max_steps, imperfections, observer)
    episode.set_up(team)
    ending = episode.ending()
    while ending is None:
        if newcomer is not None and episode.step == join_step:
            if alone is not None:
                check_shared_past(episode.history.links, alone, f"scenario {scenario.id!r}")
            episode.let_join(newcomer)
        try:
            episode.advance()
        except BudgetReached as reached:
            episode.budget = reached
        ending = episode.ending()
    if newcomer is not None and not episode.joined and alone is not None:
        check_shared_past(episode.history.links, alone, f"scenario {scenario.id!r}")
    return episode.result(ending, None if newcomer is None else join_step)


class _Episode:
    """The running state of one episode."""

    def __init__(
        self,
        world: World,
        scenario: Scenario,
        task: Task,
        referee: RefereeMaker,
        max_steps: int,
        imperfections: Imperfections,
        observer: EpisodeObserver,
    ) -> None:
        self.step = 0
        self.joined_at: Pose | None = None
        self.trace = Trace()
        self.understanding = Understanding()
        self.budget: BudgetReached | None = None
        self._world = world
        self._scenario = scenario
        self._task = task
        self._make_referee = referee
        self._max_steps = max_steps
        self._imperfections = imperfections
        self._observer = observer
        self._channel = Channel(imperfections.radio, scenario.seed)
        self._policies: dict[str, Policy] = {}
        self._batteries: dict[str, int] = {}
        self._observations: dict[str, Observation] = {}
        self._turns: dict[str, Turn] = {}
        self._finished: set[str] = set()
        self._failing = Failing(imperfections, scenario, world)

    @property
    def joined(self) -> bool:
        return self.joined_at is not None

    def set_up(self, team: Sequence[Policy]) -> None:
        lasting = self._imperfections.batteries(self._scenario)
        prepare(self._world, lasting)
        self._referee = self._make_referee(self._world, self._scenario)
        for seat, (member, policy) in enumerate(zip(self._scenario.team, team)):
            battery = lasting.team[seat].capability.max_steps
            self._introduce(member, self._imperfections.mind(seat, policy), battery)
        self._look()
        self._truth = self._failing.whole_truth()
        self._fail()
        self._replaced = self._referee.replaced()
        self.history = History(self._world.fingerprint())
        self.trace.objects_before = dict(self._world.truth())
        self.trace.add_step(0, self._world.agents(), {}, {})

    def let_join(self, policy: Policy) -> None:
        planned = self._scenario.newcomer
        self.joined_at = joining_pose(self._world, planned.pose)
        self._world.add_agent(planned.name, planned.capability, self.joined_at)
        self._introduce(planned, policy, planned.capability.max_steps)
        self._look()
        self._truth = self._failing.whole_truth()
        self.trace.add_event(self.step, self._truth[planned.name], "joined")

    def advance(self) -> None:
        """One step: the robots that still can confer in turn, then act in turn, then the world moves on."""
        places = {name: (truth.pose.x, truth.pose.y) for name, truth in self._truth.items()}
        self._channel.begin_step(self.step, places)
        able = [name for name in self._policies if name not in self._finished]
        for name in able:
            with self._channel.turn_of(name):
                self._policies[name].confer(self._observations[name], self._channel.inbox(name))
        actions: dict[str, Action] = {}
        self._turns = {}
        for apart, group in groupby(able, key=lambda name: self._policies[name].acts_apart):
            names = list(group)
            actions.update(self._act_apart(names) if apart else self._act_in_turn(names))
        self._observer.look(self.step, self._world, self._policies, self._observations, self._turns)
        self._observations = dict(self._world.step(actions))
        self.step += 1
        self._fail()
        self.history.add_step(actions, self._channel.log, self._world.fingerprint())
        self.trace.add_messages(self._channel.log)
        self.understanding.add(self._channel.log)
        self._note_changes(actions)

    def ending(self) -> Ending | None:
        if self.budget is not None:
            return Ending.BUDGET
        if len(self._replaced) == len(self._referee.watched):
            return Ending.REPLACED
        if len(self._finished) == len(self._policies):
            return Ending.STOPPED
        return Ending.MAX_STEPS if self.step >= self._max_steps else None

    def result(self, ending: Ending, join_step: int | None) -> EpisodeResult:
        self._observer.look(self.step, self._world, self._policies, self._observations, {})
        self.trace.objects_after = dict(self._world.truth())
        self.trace.history = list(self.history.links)
        return EpisodeResult(
            scenario=self._scenario,
            max_steps=self._max_steps,
            ending=ending,
            steps=self.step,
            watched=self._referee.watched,
            replaced=self._replaced,
            join_step=join_step,
            joined=self.joined,
            joined_at=self.joined_at,
            moved=self.joined and self.joined_at != self._scenario.newcomer.pose,
            agent_steps={name: self._truth[name].steps_used for name in self._policies},
            messages=self._channel.count,
            undeliverable=self._channel.undeliverable,
            history=tuple(self.history.links),
            trace=self.trace,
            budget=self.budget,
            deliveries=self._channel.deliveries,
            broke_down=dict(self._failing.broke_down),
            left=dict(self._failing.left),
            understood=dict(self.understanding.understood),
            not_understood=self.understanding.not_understood,
        )

    def _introduce(self, member: Member, policy: Policy, battery: int) -> None:
        ask = self._channel.ask_for(member.name)
        policy.reset(member.name, member.capability, self._task, self._scenario.seed, ask)
        self._policies[member.name] = policy
        self._batteries[member.name] = battery
        self._channel.join(member.name, policy, of_team=member is not self._scenario.newcomer)
        self.trace.agents.append(member.name)

    def _look(self) -> None:
        """Everybody looks once all are in place, so that robots placed last are seen as well."""
        self._observations = {
            name: self._world.observe(name) for name in self._policies if name not in self._failing.left
        }

    def _fail(self) -> None:
        """What breaks down or leaves before the next step does so now."""
        before = len(self._failing.left)
        for truth, event in self._failing.at(self.step):
            self._finished.add(truth.id)
            self._channel.silence(truth.id)
            self.trace.add_event(self.step, truth, event)
        if len(self._failing.left) > before:
            self._look()

    def _act_in_turn(self, names: Sequence[str]) -> Iterator[tuple[str, Action]]:
        for name in names:
            with self._channel.turn_of(name):
                turn = self._turn(name)
            yield name, self._take(name, turn)

    def _act_apart(self, names: Sequence[str]) -> Iterator[tuple[str, Action]]:
        turns = side_by_side([partial(self._turn, name) for name in names])
        return ((name, self._take(name, turn)) for name, turn in zip(names, turns))

    def _turn(self, name: str) -> Turn:
        turn = self._policies[name].act(self._observations[name], self._channel.inbox(name))
        if not isinstance(turn, Turn) or not isinstance(turn.action, Action):
            raise EpisodeError(f"{name}: act() must return a Turn with an Action, not {repr(turn)[:80]}")
        return turn

    def _take(self, name: str, turn: Turn) -> Action:
        self._channel.send(name, turn.outbox)
        self._turns[name] = turn
        self.trace.add_decision(self.step, name, turn.trace, of_team=name != self._scenario.newcomer.name)
        return turn.action

    def _note_changes(self, actions: Mapping[str, Action]) -> None:
        before, self._truth = self._truth, self._failing.whole_truth()
        self.trace.add_step(self.step, self._world.agents(), actions, self._observations)
        for name, truth in self._truth.items():
            self._note_hand(before[name], truth)
            if name not in self._finished and self._is_finished(name, truth):
                self._finished.add(name)
                self.trace.add_event(self.step, truth, "stopped" if truth.stopped else "battery empty")
                if not truth.stopped:
                    self._channel.silence(name)
        replaced = self._referee.replaced()
        for object_id in replaced:
            if object_id not in self._replaced:
                found = self._world.truth().get(object_id)
                self.trace.add_replacement(self.step, object_id, None if found is None else found.position)
        self._replaced = replaced

    def _note_hand(self, before: AgentTruth, after: AgentTruth) -> None:
        if before.held is not None and after.held != before.held:
            self.trace.add_event(self.step, after, "put down", before.held)
        if after.held is not None and after.held != before.held:
            self.trace.add_event(self.step, after, "picked up", after.held)

    def _is_finished(self, name: str, truth: AgentTruth) -> bool:
        return truth.stopped or truth.steps_used >= self._batteries[name]
