from __future__ import annotations

from adhoc.dataset.floors import ALL, floors, floors_markdown


def record(difficulty, teammates, success, partial, label="No ad hoc", join_step=None):
    return {
        "difficulty": difficulty,
        "teammates": teammates,
        "success": success,
        "partial_success": partial,
        "temporal_steps": 100 if success else 500,
        "policy_label": label,
        "join_step": join_step,
    }


RECORDS = [
    record("Easy", 3, True, 1.0),
    record("Easy", 3, False, 0.5),
    record("Easy", 4, False, 0.0),
    record("Difficult", 3, True, 1.0),
    record("Easy", 3, True, 1.0, "Random", 0),
    record("Easy", 3, False, 0.2, "Random", 50),
]


def test_rows_are_means_over_their_tasks():
    rows = {(row.difficulty, row.teammates, row.ad_hoc): row for row in floors(RECORDS)}
    own = rows["Easy", "3", "No ad hoc"]
    assert (own.tasks, own.success, own.partial_success, own.temporal_steps) == (2, 0.5, 0.75, 300)
    assert rows["Easy", ALL, "No ad hoc"].tasks == 3
    assert rows[ALL, ALL, "No ad hoc"].success == 0.5
    assert rows[ALL, ALL, "Random"].tasks == 1
    assert rows[ALL, ALL, "Random from step 50"].partial_success == 0.2
    assert ("Medium", ALL, "No ad hoc") not in rows


def test_the_table_has_a_line_for_each_group():
    lines = floors_markdown(floors(RECORDS)).splitlines()
    assert lines[0].startswith("| difficulty | team | tasks | No ad hoc %Suc | No ad hoc %PS | Random %Suc |")
    assert "| Easy | 3 | 2 | 50.0 | 75.0 | 100.0 | 100.0 | 0.0 | 20.0 |" in lines
    assert "| Easy | 4 | 1 | 0.0 | 0.0 | - | - | - | - |" in lines
    assert lines[-1].startswith("| all | all | 4 | 50.0 | 62.5 |")
