"""Every kind of team does the same before the newcomer joins, whoever that is going to be."""

from __future__ import annotations

import pytest
from hydra import compose, initialize_config_dir

from adhoc.cli.contestants import Components
from adhoc.cli.schema import register_schema
from adhoc.core.resources import data_dir
from adhoc.evaluation.episode import run_episode

JOIN_STEP, STEPS = 12, 20
CONFIGS = data_dir("configs")
TEAMS = sorted(path.stem for path in (CONFIGS / "team").glob("*.yaml") if path.stem != "with_human")
DRAW = "benchmark.draws=[{house: one_room, seed: 1, misplaced: 3, teammates: 3}]"
MIXED = [
    "+team.seats.0.agent={_target_: adhoc.agents.human.policy.HumanPolicy, script: person.txt, member: true}",
    "+team@team.seats.1=learned",
]
FAULTS = [
    "imperfections=lossy",
    "imperfections.delay=1",
    "imperfections.jitter=2",
    "imperfections.silent=[0]",
    "imperfections.wrong={1:0.5}",
    "imperfections.untruthful={2:0.5}",
    "imperfections.breaks_down={0:6}",
]


def past(*overrides: str, policy: str) -> tuple[tuple[str, ...], bool]:
    """The hashes of all steps before the newcomer acts, and whether it joined."""
    register_schema()
    with initialize_config_dir(str(CONFIGS), version_base="1.3"):
        made = Components(compose("run", [DRAW, f"policy={policy}", *overrides]))
    (scenario,) = made.benchmark.scenarios(made.world, 0, None)
    team, newcomer = made.conditions.team, made.newcomer
    seats = range(len(scenario.team))
    minds = [made.conditions.imperfections.mind(seat, team.make(seat)) for seat in seats]
    result = run_episode(
        made.world,
        scenario,
        made.conditions.task,
        minds,
        None if newcomer is None else newcomer.make(len(scenario.team)),
        JOIN_STEP,
        STEPS,
        imperfections=made.conditions.imperfections,
    )
    made.world.close()
    return result.history[: JOIN_STEP + 1], result.joined


@pytest.mark.parametrize("team", TEAMS)
def test_a_team_alone_and_joined(team):
    alone, _ = past(f"team={team}", policy="none")
    joined, did_join = past(f"team={team}", policy="irot")
    assert did_join
    assert len(alone) == JOIN_STEP + 1
    assert joined == alone


@pytest.mark.parametrize("team", ["heuristic", "learned", "llm"])
def test_a_team_with_every_fault_alone_and_joined(team):
    alone, _ = past(f"team={team}", *FAULTS, policy="none")
    joined, did_join = past(f"team={team}", *FAULTS, policy="random")
    assert did_join
    assert joined == alone


def test_a_team_with_a_person_and_a_learned_robot(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "person.txt").write_text("explore\n", encoding="utf-8")
    overrides = ["team=llm", *MIXED]
    alone, _ = past(*overrides, policy="none")
    joined, did_join = past(*overrides, policy="plastic")
    assert did_join
    assert joined == alone
