"""Predictions of teammates, held against what they did."""

from __future__ import annotations

import io

import pytest
from grid_world import Errand, GridWorld, Script, scenario
from rich.console import Console

from adhoc import (
    HeuristicPolicy,
    LLMAgent,
    LLMSubSkillPlanner,
    OfflineReasoner,
    PyBulletWorld,
    StagedPlanner,
    TidyingUp,
    placement_table,
    sample_house,
    sample_scenario,
)
from adhoc.agents.policy import Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.predictions import Doings, Foresight
from adhoc.evaluation.transcript import write_transcript
from adhoc.planning.gpl import GPLEvaluator, GPLGenerator
from adhoc.planning.reflect import AcceptFirst
from adhoc.reporting.prediction_table import prediction_table
from adhoc.reporting.rendering.markdown import markdown_table
from adhoc.reporting.rendering.terminal import terminal_table
from adhoc.reporting.results import Results


def doings(*sub_tasks: str | None) -> Doings:
    """What `mate` does, step by step from 0."""
    made = Doings()
    for step, sub_task in enumerate(sub_tasks):
        made.tell(step, "mate", {"sub_task": sub_task, "sub_skill": None})
    return made


class TestDoings:
    @pytest.mark.parametrize(
        ("step", "within", "expected"),
        [
            (0, 20, "a"),  # nothing was done before
            (1, 20, "b"),
            (1, 2, "a"),  # b comes at step 3: too late
            (1, 3, "b"),
            (3, 20, "b"),  # at step 3 nobody can know yet that b has begun
            (4, 20, "c"),
            (7, 20, "c"),  # c to the end
        ],
    )
    def test_the_next_is_the_first_other_thing_else_the_same(self, step, within, expected):
        made = doings("a", "a", "a", "b", "b", None, "c", "c")
        assert made.next("mate", "sub_task", step, within) == expected

    def test_going_on_after_a_pause_is_no_other_thing(self):
        assert doings("a", None, "a", "a").next("mate", "sub_task", 1) == "a"

    def test_nothing_known_is_none(self):
        assert doings("a").next("mate", "sub_skill", 0) is None
        assert doings("a").next("stranger", "sub_task", 0) is None

    def test_a_robot_out_of_order_does_nothing(self):
        made = doings("a", "b")
        assert made.next("mate", "sub_task", 1) == "b"
        assert made.next("mate", "sub_task", 2) is None

    def test_a_robot_that_stopped_does_stop(self):
        made = doings("a", "a", "a")
        made.stop(2, "mate")
        made.tell(3, "mate", {"sub_task": None, "sub_skill": None})
        assert made.next("mate", "sub_task", 1) == "Stop"
        assert made.next("mate", "sub_skill", 9) == "Stop"

    def test_robots_that_do_not_tell_of_themselves_are_taken_at_their_public_word(self):
        made = Doings()
        for step, payload in enumerate(
            ({"sub_task": {"name": "Fetch", "args": ["x", 2.0]}}, {}, {"sub_task": 3})
        ):
            made.hear([Message(MessageKind.TASK_STATE, "", payload, None, "mate", step)])
        assert made.next("mate", "sub_task", 0) == "Fetch x 2"
        assert made.next("mate", "sub_task", 5) is None

    def test_whoever_tells_of_itself_cannot_be_misheard(self):
        made = doings("a", "a")
        lie = {"sub_task": {"name": "b", "args": []}}
        made.hear([Message(MessageKind.TASK_STATE, "", lie, None, "mate", 1)])
        assert made.next("mate", "sub_task", 1) == "a"


def predicting(step: int, sub_task: str | None, sub_skill: str | None = None) -> dict[str, object]:
    return {"decision": {"predictions": [{"teammate": "mate", "sub_task": sub_task, "sub_skill": sub_skill}]}}


class TestForesight:
    def test_each_prediction_is_counted_once(self):
        foresight = Foresight(doings=doings(*["Explore room_1"] * 3, *["Explore room_2"] * 30))
        for step, sub_task in ((1, "Explore room_2"), (1, "Explore room_3"), (1, None), (1, "Stop")):
            foresight.add(step, "newcomer", predicting(step, sub_task), of_team=False)
        foresight.add(1, "newcomer", predicting(1, None, "Explore"), of_team=False)
        assert foresight.counts(of_team=False) == {
            "within": 20,
            "sub_tasks": {"made": 3, "judged": 3, "right": 1, "named": 2},
            "sub_skills": {"made": 1, "judged": 0, "right": 0, "named": 0},
        }
        assert foresight.counts(of_team=True)["sub_tasks"]["made"] == 0

    def test_how_soon_a_change_must_come_is_a_parameter(self):
        foresight = Foresight(doings=doings(*["a"] * 10, "b", "b"))
        foresight.add(5, "newcomer", predicting(5, "b"), of_team=False)
        right = [foresight.counts(False, within)["sub_tasks"]["right"] for within in (5, 6)]
        assert right == [0, 1]


class Telling(Script):
    """Tells what it does: one thing until step 4, then another."""

    def act(self, observation, inbox):
        sub_task = "Visit one" if observation.step < 4 else "Visit two"
        turn = super().act(observation, inbox)
        return Turn(turn.action, turn.outbox, {"doing": {"sub_task": sub_task, "sub_skill": "Wait"}})


class Seer(Script):
    """Predicts at its first and its second step."""

    def act(self, observation, inbox):
        turn = super().act(observation, inbox)
        if observation.step > 2:
            return turn
        predictions = [
            {"teammate": "teammate_1", "sub_task": "Visit two", "sub_skill": "Wait"},
            {"teammate": "teammate_2", "sub_task": "Visit two", "sub_skill": None},
        ]
        return Turn(turn.action, turn.outbox, {"decision": {"predictions": predictions}})


def test_an_episode_holds_what_was_predicted_against_what_was_done():
    team = [Telling(), Script(Action(ActionName.STOP))]
    result = run_episode(GridWorld(), scenario(), Errand(), team, Seer(), join_step=1, max_steps=10)
    assert result.trace.foresight.counts(of_team=False) == {
        "within": 20,
        "sub_tasks": {"made": 4, "judged": 4, "right": 2, "named": 2},
        "sub_skills": {"made": 2, "judged": 2, "right": 2, "named": 2},
    }
    assert len(result.trace.decisions) == 2, "what robots tell of themselves at every step is not kept"


def record(policy: str, right: int, made: int = 4, team: str = "Heuristic based", model: str = "m"):
    counts = {"made": made, "judged": made, "right": right, "named": right}
    none = {"made": 0, "judged": 0, "right": 0, "named": 0}
    found = {"within": 20, "sub_tasks": counts, "sub_skills": none}
    row = {"team": team, "team_label": team, "policy": policy, "policy_label": policy, "model": model}
    where = {"task_id": "t", "scenario_hash": "s", "max_steps": 500, "join_step": 0, "config_hash": "c"}
    return {**row, **where, "predictions": found}


class TestTable:
    def test_rows_add_up_and_who_predicts_nothing_has_none(self):
        records = [
            record("GPL-LLM", 1),
            record("GPL-LLM", 2),
            record("IRoT-LLM", 0, 0),
            {name: it for name, it in record("old", 1).items() if name != "predictions"},
        ]
        text = markdown_table(prediction_table(Results.of(records)))
        assert "| Heuristic based | GPL-LLM | 37.5 | 37.5 | 8 of 8 | - | - | 0 of 0 |" in text
        assert text.count("\n| ") == 2
        assert "first new one within 20 steps" in text

    def test_teams_and_models_are_told_apart(self):
        records = [record("GPL", 1), record("GPL", 2, team="LLM"), record("GPL", 3, model="n")]
        rows = markdown_table(prediction_table(Results.of(records))).splitlines()[4:7]
        assert [row.split(" | ")[:3] for row in rows] == [
            ["| Heuristic based", "GPL (m)", "25.0"],
            ["| Heuristic based", "GPL (n)", "75.0"],
            ["| LLM", "GPL", "50.0"],
        ]

    def test_without_predictions_there_is_no_table(self):
        assert prediction_table(Results.of([record("IRoT-LLM", 0, 0)])) is None
        assert prediction_table(Results.of([])) is None

    def test_the_table_for_the_terminal_says_the_same(self):
        console = Console(width=110, file=io.StringIO())
        console.print(terminal_table(prediction_table(Results.of([record("GPL-LLM", 1)]))))
        assert "25.0" in console.file.getvalue()


def test_gpl_and_the_heuristic_team_tell_all_that_is_needed():
    model = OfflineReasoner(placement_table())
    gpl = StagedPlanner(GPLGenerator(model), GPLEvaluator(model), AcceptFirst(), TidyingUp().legal)
    world = PyBulletWorld(image_size=64)
    drawn = sample_scenario(world, sample_house("one_room"), seed=1, misplaced=2, teammates=2)
    newcomer = LLMAgent(gpl, LLMSubSkillPlanner(model))
    result = run_episode(world, drawn, TidyingUp(), [HeuristicPolicy(), HeuristicPolicy()], newcomer, 3, 40)
    world.close()
    counts = result.trace.foresight.counts(of_team=False)
    assert counts["sub_tasks"]["made"] > 1
    assert counts["sub_tasks"]["judged"] == counts["sub_tasks"]["made"]
    assert counts["sub_tasks"]["right"] > 0
    assert counts["sub_skills"]["judged"] > 0
    names = [member.name for member in drawn.team]
    for name in (*names, drawn.newcomer.name):
        assert result.trace.foresight.doings.next(name, "sub_task", 5) is not None
    page = write_transcript(result, {"episode_id": "x", "policy_label": "GPL-LLM", "model": None})
    assert page is not None
    assert "## Predictions\n\n- **teammate_1**: `Explore " in page
