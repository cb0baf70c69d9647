from __future__ import annotations

import pytest
from test_records import record

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import RecordFile
from adhoc.reporting.folders import read_folders
from adhoc.reporting.paper_layout import paper_tables, result_cells
from adhoc.reporting.rendering.markdown import markdown_table
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results


def episode(task, policy=None, join_step=None, model=None, **changes):
    fields = {
        "task_id": task,
        "scenario_hash": task,
        "max_steps": 500,
        "team_label": "Heuristic based",
        "policy": policy or "none",
        "policy_label": policy or "No ad hoc",
        "join_step": join_step,
        "joined": True,
        "model": model,
        "episode_id": f"{task}-{policy}-{join_step}-{model}",
        "efficiency": None if policy is None else 0.0,
        **changes,
    }
    return record(**fields)


def cells_of(row):
    return [row.team_name, row.ad_hoc, *(cell.text for cell in result_cells(row))]


def failed(task, *arguments, **changes):
    failure = {"success": False, "partial_success": 0.5, "temporal_steps": 500, "action_steps": 1500}
    return episode(task, *arguments, **{**failure, **changes})


RECORDS = [
    failed("a"),
    episode("b", temporal_steps=200, action_steps=500),
    episode("a", "IRoT-LLM", 50, "tiny", temporal_steps=250, action_steps=800, efficiency=0.5),
    episode("b", "IRoT-LLM", 50, "tiny", temporal_steps=150, action_steps=600, efficiency=0.25),
    failed("a", "Random", 50, action_steps=1950),
    failed("a", "Random", 0, action_steps=2000),
]


def test_rows_are_worked_out_over_paired_episodes():
    report = make_report(Results.of(RECORDS))
    assert [block.join_step for block in report.blocks] == [0, 50]
    alone, irot, random = (cells_of(row) for row in report.blocks[1].rows)
    assert alone == [
        "Heuristic based", "No ad hoc", "50.0 (-)", "75.0 (-)", "350.0 (-)", "1000.0 (-)", "-", "2",
    ]  # fmt: skip
    assert irot[1:] == [
        "IRoT-LLM", "100.0 (100.0)", "100.0 (33.3)", "200.0 (42.9)", "700.0 (30.0)", "37.5", "2",
    ]  # fmt: skip
    assert random[1:] == [
        "Random", "0.0 (0.0)", "50.0 (0.0)", "500.0 (0.0)", "1950.0 (-30.0)", "0.0", "1",
    ]  # fmt: skip


def test_the_block_of_another_step_only_counts_its_own_pairs():
    alone, random = make_report(Results.of(RECORDS)).blocks[0].rows
    assert alone.scores.episodes == 1
    assert alone.scores.success == 0.0
    assert random.gain is not None
    assert random.gain.action_steps == pytest.approx(-100 / 3)


def test_the_model_and_the_number_of_pairs_are_named():
    report = make_report(Results.of(RECORDS))
    assert report.title.endswith("language model: tiny")
    assert report.notes[:2] == (
        "scenarios: 2; houses: 1; steps: at most 500",
        "4 paired episodes, N in a row",
    )
    table = list(paper_tables(report))[1]
    assert table.title == "The ad hoc robot joins at step 50; language model: tiny"
    assert "| Heuristic based | IRoT-LLM | **100.0 (100.0)** |" in markdown_table(table)


def test_success_where_the_team_never_had_any_has_no_percentage():
    records = [failed("a"), episode("a", "IRoT-LLM", 0, "tiny")]
    assert cells_of(make_report(Results.of(records)).blocks[0].rows[1])[2] == "100.0 (n/a)"


def test_two_models_of_one_policy_are_two_rows():
    records = [*RECORDS, failed("a", "IRoT-LLM", 50, "huge")]
    names = [row.ad_hoc for row in make_report(Results.of(records)).blocks[1].rows]
    assert names == ["No ad hoc", "IRoT-LLM (huge)", "IRoT-LLM (tiny)", "Random"]
    assert make_report(Results.of(records)).title.endswith("language model: huge, tiny")


def test_episodes_without_their_team_alone_are_left_out_and_counted():
    report = make_report(Results.of([*RECORDS, episode("c", "Random", 50)]))
    assert report.blocks[1].rows[0].scores.episodes == 2
    assert any("1 episode left out" in note for note in report.notes)


def test_a_folder_of_the_team_alone():
    report = make_report(Results.of(RECORDS[:2]))
    assert report.blocks[0].join_step is None
    assert [row.ad_hoc for row in report.blocks[0].rows] == ["No ad hoc"]


def test_late_newcomers_are_counted():
    late = failed("a", "Random", 90, joined=False)
    assert any("1 of them ended before" in note for note in make_report(Results.of([*RECORDS, late])).notes)


def talk(asked, invalid, sub_tasks, fallbacks, repaired=0):
    outcomes = {"valid": asked - invalid - repaired, "repaired": repaired, "invalid": invalid, "illegal": 99}
    return {
        "llm": {"calls": 1000, "invalid": invalid, "repaired": repaired, "outcomes": outcomes},
        "planning": {"sub_tasks": sub_tasks, "fallbacks": fallbacks},
        "team_planning": {"sub_tasks": 2 * sub_tasks, "fallbacks": 2 * fallbacks},
    }


def test_what_is_not_the_models_doing_is_told_for_each_row():
    records = [
        failed("a"),
        failed("a", "IRoT-LLM", 50, "tiny", **talk(60, 60, 13, 13)),
        failed("a", "IRoT-LLM", 0, "tiny", **talk(36, 36, 10, 10)),
        failed("a", "IRoT-LLM", 50, "huge", **talk(40, 0, 10, 1)),
        failed("a", "CoT-LLM", 50, "tiny", **talk(40, 2, 10, 0, 7)),
        failed("a", "Naive-LLM", 50, "tiny", **talk(40, 0, 10, 0)),
        failed("left out", "Naive-LLM", 50, "tiny", **talk(40, 40, 10, 10)),
    ]
    report = make_report(Results.of(records))
    assert sorted(it for it in report.warnings if "scenarios" not in it) == [
        "CoT-LLM: 2 of 40 questions to the model got no usable reply; 7 of 40 only when asked again",
        "IRoT-LLM (huge): 1 of 10 decisions fell back to the safe choice",
        "IRoT-LLM (tiny): 96 of 96 questions to the model got no usable reply; "
        "23 of 23 decisions fell back to the safe choice",
    ]


def test_newcomers_without_the_team_alone_are_counted_and_nothing_else():
    report = make_report(Results.of([it for it in RECORDS if it["join_step"] is not None]))
    assert report.blocks == ()
    assert any(it.startswith("4 episodes left out") for it in report.notes)


def test_the_order_in_which_episodes_ended_does_not_matter():
    talked = [
        failed(task, label, step, "tiny", **talk(100, 4, 100, 4))
        for task in ("a", "b")
        for label in ("IRoT-LLM", "CoT-LLM", "Mine", "Another")
        for step in (0, 50)
    ]
    records = [failed("a"), failed("b"), *talked]
    assert make_report(Results.of(records[::-1]), intervals=True) == make_report(
        Results.of(records), intervals=True
    )


def test_a_few_misunderstandings_are_a_note_and_no_warning():
    report = make_report(
        Results.of([failed("a"), failed("a", "IRoT-LLM", 50, "tiny", **talk(100, 4, 100, 4))])
    )
    assert report.warnings == ()
    assert report.notes[-1] == (
        "IRoT-LLM: 4 of 100 questions to the model got no usable reply; "
        "4 of 100 decisions fell back to the safe choice"
    )


def test_several_versions_of_the_library_are_a_warning_that_names_them():
    records = [failed("a"), failed("a", "Random", 0, library_version="1.2")]
    assert make_report(Results.of(records)).warnings == (
        "made by several versions of the library, which may differ in what they do: 0 (1 episode), 1.2 (1 "
        "episode)",
    )


def test_rows_over_other_tasks_than_their_neighbours_are_told():
    (warning,) = (it for it in make_report(Results.of(RECORDS)).warnings if "scenarios" in it)
    assert warning == (
        "Heuristic based, joining at step 50: rows are over different scenarios: compare within a row "
        "only (Random 1 of 2 scenarios)"
    )


OTHER = {"team": "llm", "team_label": "LLM based"}


def test_teams_over_other_tasks_than_each_other_are_told():
    records = [
        *(failed(it) for it in "abc"),
        *(failed(it, "Random", 0) for it in "abc"),
        *(failed(it, episode_id=f"{it} other", **OTHER) for it in "cd"),
        *(failed(it, "Random", 0, episode_id=f"{it} joined", **OTHER) for it in "cd"),
    ]
    assert make_report(Results.of(records)).warnings == (
        "joining at step 0: rows are over different scenarios: compare within a row only "
        "(Heuristic based 3, LLM based 2; 1 scenario shared by all)",
    )
    alone = [it for it in records if it["join_step"] is None]
    assert (
        make_report(Results.of(alone))
        .warnings[0]
        .startswith("the team alone: rows are over different scenarios")
    )
    same = [it for it in records if it["task_id"] == "c"]
    assert make_report(Results.of(same)).warnings == ()


def won(task, first_help, policy="Random", **changes):
    return episode(task, policy, 0, first_help=first_help, **changes)


def test_success_without_an_object_that_the_newcomer_placed_is_told_with_its_count():
    alone = [failed(it) for it in "abc"]
    records = [*alone, won("a", None), won("b", None), failed("c", "Random", 0, first_help=3)]
    assert [row.unaided for row in make_report(Results.of(records)).blocks[0].rows] == [0, 2]
    (table,) = paper_tables(make_report(Results.of(records)))
    assert table.remarks == (
        "more success without any object that the newcomer placed in the tasks won (its presence, messages "
        "or body changed what the team did): Random beside Heuristic based (2 tasks)",
    )


def test_success_that_the_newcomer_may_have_brought_is_no_remark():
    alone = [failed("a"), failed("b"), episode("c")]
    even = [won("a", None), failed("b", "Random", 0), failed("c", "Random", 0)]
    helped = [won("a", None), won("b", 7), won("c", None)]
    untold = [episode("a", "Random", 0)]
    for joined in (even, helped, untold):
        (table,) = paper_tables(make_report(Results.of([*alone, *joined])))
        assert table.remarks == ()


def test_two_versions_of_a_task_are_told():
    records = [failed("a"), failed("a", scenario_hash="other", episode_id="again")]
    assert make_report(Results.of(records)).warnings[0].startswith("1 task is there in several versions")


def test_a_team_with_a_model_is_told_of_too():
    assert make_report(Results.of([failed("a", **talk(3, 2, 5, 1))])).warnings == (
        "Heuristic based alone: 2 of 3 questions to the model got no usable reply; "
        "2 of 10 decisions fell back to the safe choice",
    )


def test_folders_are_read_together_and_errors_name_them(tmp_path):
    for name, some in (("one", RECORDS[:3]), ("two", RECORDS[3:])):
        for it in some:
            RecordFile(tmp_path / name).append(it)
    assert len(read_folders([tmp_path / "one", tmp_path / "two"])) == 6
    with pytest.raises(RecordError, match="no episode records"):
        read_folders([tmp_path / "three"])
    with pytest.raises(RecordError, match="in another folder as well"):
        read_folders([tmp_path / "one", tmp_path / "one"])
