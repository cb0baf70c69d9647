"""Carrying plans out in the real world, and planning anew whenever the world disagrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import ActionName, ActionResult, Failure
from adhoc.dataset.oracle.coordination import Route
from adhoc.dataset.oracle.knowledge import NOTHING_REFUSED, HouseKnowledge, Refusals, Rules
from adhoc.dataset.oracle.plans import NoPlan, Plan, Planner, Worker
from adhoc.dataset.oracle.scripts import script_of
from adhoc.dataset.oracle.situation import Situation
from adhoc.dataset.oracle.stances import AIMS, aim_of
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Member, Scenario
from adhoc.houses.house import FLOOR
from adhoc.worlds.world import AgentTruth, World


@dataclass(frozen=True)
class Outcome:
    """What became of one run: the steps until the referee saw everything in place, or why it never did."""

    steps: int | None
    reason: str
    plans: int
    """How often the run was planned."""


@dataclass
class Run:
    """One attempt of a team to do a whole scenario, in a world in which it has been set up.

    Args:
        world: the world, with all members in it.
        scenario: what was set up.
        house: what is known of its house.
        members: the robots.
        max_steps: the step limit.
        rules: of the world.
        first: the planner of the situation at the beginning, if another run has made one.
        bystander: the name of a robot that is to carry nothing.
    """

    world: World
    scenario: Scenario
    house: HouseKnowledge
    members: Sequence[Member]
    max_steps: int
    rules: Rules
    first: Planner | None = None
    bystander: str = ""
    steps: int = 0
    plans: int = 0
    _refusals: Refusals = field(default_factory=Refusals)

    def execute(self) -> Outcome:
        """Plan and act until everything is in place, or nothing more can be done."""
        referee = PlacementReferee(self.world, self.scenario)
        reason = ""
        while self.plans < self.rules.most_plans:
            missing = [name for name in referee.watched if name not in referee.replaced()]
            if not missing:
                return Outcome(self.steps, "", self.plans)
            planner = self._planner(missing)
            self.plans += 1
            plan = planner.plan(self._workers(planner.situation), self.max_steps - self.steps)
            if isinstance(plan, NoPlan):
                return Outcome(None, plan.reason, self.plans)
            before = self.steps
            reason = self._follow(plan, planner.situation)
            if not reason and plan.left and self.steps == before:
                break
        if len(referee.replaced()) == len(referee.watched):
            return Outcome(self.steps, "", self.plans)
        return Outcome(
            None, f"too many plans failed, the last because {reason or 'objects were left'}", self.plans
        )

    def _planner(self, missing: Sequence[str]) -> Planner:
        if self.first is not None and self.steps == 0 and self.plans == 0:
            return self.first
        return Planner(
            situation_now(self.world, self.house, self.members, missing, self.rules, self._refusals)
        )

    def _workers(self, situation: Situation) -> list[Worker]:
        agents = self.world.agents()
        return [self._worker(situation, member, agents[member.name]) for member in self.members]

    def _worker(self, situation: Situation, member: Member, agent: AgentTruth) -> Worker:
        ability = member.capability
        cell, aim = situation.lattice.cell_at(agent.pose.x, agent.pose.y), aim_of(agent.pose)
        if cell is None or aim is None:
            raise ConfigurationError(
                f"scenario {self.scenario.id!r}: {member.name!r} at {agent.pose} is not on the lattice of "
                "robots (multiples of 0.25 m, 90 degrees of yaw and 30 degrees of pitch)"
            )
        left = 0 if agent.stopped else max(0, ability.max_steps - agent.steps_used)
        carries = frozenset(
            name
            for name in situation.objects
            if ability.can_manipulate
            and member.name != self.bystander
            and self.house.mass(name) * self.rules.mass_scale <= ability.payload
            and (name in situation.lying or name == agent.held)
        )
        held = agent.held if agent.held in situation.objects else None
        return Worker(
            member.name,
            AIMS * cell + aim,
            ability.camera_height,
            left,
            ability.can_navigate and left > 0,
            carries,
            held,
        )

    def _follow(self, plan: Plan, situation: Situation) -> str:
        """Carry a plan out up to its end, or to the first thing that makes another one necessary."""
        heights = {member.name: member.capability.camera_height for member in self.members}
        for step, actions in enumerate(script_of(plan, situation, heights)):
            observations = self.world.step(actions)
            self.steps += 1
            refused = ""
            for name in actions:
                result = observations[name].last_result
                if result is not None and result.failure is not None:
                    self._learn(situation, plan.routes[name], name, heights[name], step, result)
                    refused = f"{name} could not {result.action}: {result.failure.value}"
            if refused:
                return refused
            if step + 1 < plan.steps and any(it.name is ActionName.DROP for it in actions.values()):
                return "an object lies on the floor now"
        return ""

    def _learn(
        self,
        situation: Situation,
        route: Route,
        name: str,
        height: float,
        step: int,
        result: ActionResult,
    ) -> None:
        """Remember what the world refused."""
        cell, aim = divmod(route.stances[step], AIMS)
        x, y = situation.lattice.points[cell].tolist()
        refusals, action = self._refusals, result.action
        held = self.world.agents()[name].held
        if result.failure is Failure.BLOCKED:
            blocked = (x, y, route.deeds[step])
            self._refusals = replace(refusals, steps=refusals.steps | {blocked})
        elif result.failure is Failure.NO_FREE_PLACE and held is not None and action.target is not None:
            self._refusals = replace(refusals, receptacles=refusals.receptacles | {(held, action.target)})
        else:
            target = FLOOR if action.target is None else action.target
            self._refusals = replace(refusals, stances=refusals.stances | {(target, height, x, y, aim)})


def situation_now(
    world: World,
    house: HouseKnowledge,
    members: Sequence[Member],
    missing: Sequence[str],
    rules: Rules,
    refusals: Refusals = NOTHING_REFUSED,
    expected: Sequence[tuple[float, float]] = (),
) -> Situation:
    """The situation that a world is in; `expected` are points where more robots will come to stand."""
    agents = world.agents()
    places = [(agents[member.name].pose, member.capability, agents[member.name]) for member in members]
    stuck = [
        (pose.x, pose.y)
        for pose, ability, agent in places
        if not ability.can_navigate or agent.stopped or agent.steps_used >= ability.max_steps
    ]
    stands = [*expected, *((pose.x, pose.y) for pose, _, _ in places)]
    return Situation(house, world.truth(), missing, rules, refusals, stuck, stands)
