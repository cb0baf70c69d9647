"""The ceiling of a task: what a planner that knows everything makes of it, shown in the real world."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from adhoc.dataset.oracle.execution import Outcome, Run, situation_now
from adhoc.dataset.oracle.knowledge import PYBULLET, HouseKnowledge, Rules
from adhoc.dataset.oracle.least_steps import least_steps
from adhoc.dataset.oracle.plans import Planner
from adhoc.dataset.oracle.proofs import out_of_sight, too_heavy
from adhoc.evaluation.joining import joining_pose
from adhoc.evaluation.scenario import Member, Scenario, prepare
from adhoc.worlds.world import World

Kind = Literal["team", "newcomer", "none"]


@dataclass(frozen=True)
class Ceiling:
    """The best that was done in one task by robots that are commanded together and know everything.

    `kind` says who is needed: `team`, the original team alone puts every misplaced object into a right place;
    `newcomer`, it does not, but it does together with the newcomer that joins at step 0; `none`, neither.
    """

    task_id: str
    kind: Kind
    team_steps: int | None
    """Steps that the team alone took; None if it was not solved."""
    joint_steps: int | None
    """Steps that the team and the newcomer took together; None if it was not solved."""
    reason: str = ""
    """Why not, for the kind `none`; else empty."""
    proven: bool = True
    """Whether the kind is certain. What was done is proven by doing it. Failure is proven where nobody can
    carry an object, or no robot that can carry it can see it within reach (see `oracle.proofs`). All other
    failures are the oracle's own: with it, whoever picks an object up carries it straight to a right place
    (nothing is put down on the way, for another robot or for later), and it gives up early."""
    least_steps: int | None = None
    """The team and the newcomer cannot take fewer steps unless something is put down on the way (see
    `oracle.least_steps`); None if even that relaxed task cannot be done."""
    team_reason: str = ""
    """Why the team alone failed, for every kind but `team`."""


def ceiling(world: World, scenario: Scenario, max_steps: int = 500, rules: Rules = PYBULLET) -> Ceiling:
    """Let the oracle try one task, first with the team alone, then with the newcomer as well.

    The oracle knows the house, the facts of right places and all robots, and plans centrally; its actions
    are real ones, every battery counts, and the referee of the evaluation says when the task is done. It is
    an achievable bound: a better plan may exist (see `Ceiling.least_steps`), above all one that puts
    things down on the way, which the oracle never does. It is for evaluation only: no policy can reach it.

    Args:
        world: a world whose sizes are those of `rules` and else the defaults of `PyBulletWorld`; it is reset.
        scenario: the task.
        max_steps: the step limit.
        rules: what the world is like, e.g. its factor on masses.

    Raises:
        ConfigurationError: A robot is not on the lattice of robots.
        HouseError, WorldError: The scenario cannot be set up.
    """
    house = HouseKnowledge(scenario.house)
    objects = [displacement.object_id for displacement in scenario.misplaced]
    everybody = (*scenario.team, scenario.newcomer)
    heavy = too_heavy(house, objects, everybody, rules)
    if heavy is not None:
        reason = f"no robot can carry {heavy}"
        return Ceiling(scenario.id, "none", None, None, reason, True, None, reason)
    planner = _set_up(world, scenario, house, rules)
    alone = _try_alone(world, scenario, house, max_steps, rules, planner)
    if alone.steps is None and not alone.proof:
        hidden = out_of_sight(house, world.truth(), objects, scenario.team, rules)
        alone = replace(alone, proof="" if hidden is None else _unseen(hidden, "robot of the team"))
    as_planned = _let_join(world, scenario.newcomer)
    least = least_steps(planner.situation, world, everybody, max_steps, rules)
    if alone.proof:
        hidden = out_of_sight(house, world.truth(), objects, everybody, rules)
        if hidden is not None:
            reason = _unseen(hidden, "robot")
            return Ceiling(scenario.id, "none", None, None, reason, True, least, alone.proof)
    first = planner if as_planned else None
    joint = Run(world, scenario, house, everybody, max_steps, rules, first).execute()
    if alone.steps is not None and (joint.steps is None or joint.steps > alone.steps):
        prepare(world, scenario)
        _let_join(world, scenario.newcomer)
        aside = Run(
            world, scenario, house, everybody, max_steps, rules, first, bystander=scenario.newcomer.name
        )
        joint = min((joint, aside.execute()), key=lambda outcome: outcome.steps or max_steps + 1)
    return _judged(scenario.id, alone, joint, least)


@dataclass(frozen=True)
class _Alone:
    """What became of the team alone; `proof` says why it is impossible, if that is proven."""

    steps: int | None
    reason: str
    proof: str = ""


def _try_alone(
    world: World, scenario: Scenario, house: HouseKnowledge, max_steps: int, rules: Rules, planner: Planner
) -> _Alone:
    """Run the team alone, and set the scenario up again; nothing is run where payloads rule it out."""
    objects = planner.situation.objects
    heavy = too_heavy(house, objects, scenario.team, rules)
    if heavy is not None:
        reason = f"no robot of the team can carry {heavy}"
        return _Alone(None, reason, reason)
    outcome = Run(world, scenario, house, scenario.team, max_steps, rules, planner).execute()
    prepare(world, scenario)
    return _Alone(outcome.steps, outcome.reason)


def _unseen(object_id: str, robot: str) -> str:
    return f"no {robot} that can carry {object_id} can see it within reach"


def _set_up(world: World, scenario: Scenario, house: HouseKnowledge, rules: Rules) -> Planner:
    prepare(world, scenario)
    missing = [displacement.object_id for displacement in scenario.misplaced]
    joining = (scenario.newcomer.pose.x, scenario.newcomer.pose.y)
    return Planner(situation_now(world, house, scenario.team, missing, rules, expected=[joining]))


def _let_join(world: World, newcomer: Member) -> bool:
    """Add the newcomer; whether what was planned for the team alone holds with it as well."""
    pose = joining_pose(world, newcomer.pose)
    world.add_agent(newcomer.name, newcomer.capability, pose)
    return pose == newcomer.pose and newcomer.capability.can_navigate


def _judged(task_id: str, alone: _Alone, joint: Outcome, least: int | None) -> Ceiling:
    if alone.steps is not None:
        return Ceiling(task_id, "team", alone.steps, joint.steps, "", True, least)
    team_reason = alone.proof or alone.reason
    if joint.steps is not None:
        return Ceiling(task_id, "newcomer", None, joint.steps, "", bool(alone.proof), least, team_reason)
    reason = f"not solved by the oracle: {joint.reason}"
    if least is None:
        reason += " (it cannot be without putting something down on the way)"
    return Ceiling(task_id, "none", None, None, reason, False, least, team_reason)
