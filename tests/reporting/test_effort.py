"""What a success takes, worked out by hand."""

from __future__ import annotations

from test_report import episode, failed

from adhoc.llm.offline.reasoner import OFFLINE_NAME
from adhoc.reporting.effort_table import COLUMNS, effort_table, first_helps
from adhoc.reporting.results import Results

ABLE, UNABLE = ({"can_manipulate": can, "payload": 5.0} for can in (True, False))


def llm(calls, tokens_in, tokens_out, usd, invalid=0, valid=0):
    return {
        "calls": calls, "prompt_tokens": tokens_in, "completion_tokens": tokens_out, "cost_usd": usd,
        "invalid": invalid, "outcomes": {"valid": valid, "repaired": 0, "invalid": invalid, "illegal": 50},
    }  # fmt: skip


RECORDS = [
    episode("a", newcomer=None, first_help=None),
    failed("b", newcomer=None, first_help=None),
    episode("a", "irot", 0, "gpt", newcomer=ABLE, first_help=40, llm=llm(10, 1000, 100, 0.5, 1, 9)),
    episode("b", "irot", 0, "gpt", newcomer=ABLE, first_help=61, llm=llm(20, 2000, 200, 1.0, 2, 28)),
    failed("c", "irot", 0, "gpt", newcomer=ABLE, first_help=None, llm=llm(30, 3000, 300, 2.0)),
    failed("d", "irot", 0, "gpt", newcomer=UNABLE, first_help=None, llm=llm(0, 0, 0, 0.0)),
    failed("e", "irot", 0, "gpt", newcomer=ABLE, first_help=None, joined=False, llm=llm(0, 0, 0, 0.0)),
    failed("a", "naive", 0, "gpt", newcomer=ABLE, first_help=None, llm=llm(3, 5, 5, 0.1, 0, 3)),
    episode("a", "cot", 50, OFFLINE_NAME, newcomer=ABLE, first_help=7, llm=llm(4, 900, 90, 0.0, 0, 4)),
    episode("a", "random", 50),
]


def rows(records):
    table = effort_table(Results.of(records))
    assert table is not None
    return [[cell.text for cell in row.cells] for group in table.groups for row in group]


def test_everything_is_for_each_success_and_counts_failures_too():
    assert rows(RECORDS) == [
        ["Heuristic based", "No ad hoc", "-", "1 of 2", "-", "-", "-", "-", "-", "-", "-"],
        ["Heuristic based", "random", "50", "1 of 1", "-", "-", "-", "-", "-", "-", "-"],
        ["Heuristic based", "naive", "0", "0 of 1", "-", "-", "-", "-", "0.0", "0 of 1", "-"],
        ["Heuristic based", "cot", "50", "1 of 1", "4", "-", "-", "-", "0.0", "1 of 1", "7"],
        # 60 calls, 6000 and 600 tokens, 3.50 USD for two successes; 3 of 40 questions; (40 + 61) / 2 steps.
        ["Heuristic based", "irot", "0", "2 of 5", "30", "3,000", "300", "1.75", "7.5", "2 of 3", "50.5"],
    ]  # fmt: skip
    assert all(len(row) == len(COLUMNS) for row in rows(RECORDS))


def test_the_title_names_the_models():
    table = effort_table(Results.of(RECORDS))
    assert table is not None
    assert table.title == f"What a success takes; language model: gpt, {OFFLINE_NAME}"


def test_only_newcomers_count_that_joined_and_can_manipulate():
    assert first_helps(RECORDS) == (5, [40, 61, 7])


def test_records_of_earlier_versions_without_a_model_give_no_table():
    assert effort_table(Results.of([episode("a"), episode("a", "random", 0)])) is None
