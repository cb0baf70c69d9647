"""Reading replies: lenient about form, strict about content."""

from __future__ import annotations

import contextlib
import json
from dataclasses import replace

import pytest
from fake_situation import CONTEXT, parcel
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.prompting.extract import read_object
from adhoc.prompting.parse import (
    read_predictions,
    read_ranking,
    read_scores,
    read_sub_skill,
    read_sub_tasks,
    read_verdict,
)

JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)


@pytest.mark.parametrize(
    "text",
    [
        '{"a": [1, 2]}',
        ' \n{"a": [1, 2]}\n',
        'Here it is:\n```json\n{"a": [1, 2]}\n```\nHope that helps {you}.',
        '```\n{"a": [1, 2,],}\n```',
        'Let me think {about it}. {"a": [1, 2]} Done.',
        'First {"a": 0}, no: {"a": [1, 2]}',
    ],
)
def test_an_object_is_found(text: str) -> None:
    assert read_object(text) == {"a": [1, 2]}


def test_python_literals_and_line_breaks_in_strings_are_forgiven() -> None:
    assert read_object('{"a": True, "b": [None, False], "c": "True, or\nnot"}') == {
        "a": True,
        "b": [None, False],
        "c": "True, or\nnot",
    }


@pytest.mark.parametrize(
    ("text", "outcome"),
    [
        ("", "empty"),
        ("  \n", "empty"),
        ("I would rather not.", "unreadable"),
        ("[1, 2]", "unreadable"),
        ('{"sub_tasks": [{"name": "Search", "args": ["room|3"]}, {"na', "truncated"),
        ('{"analysis": "hm', "truncated"),
        ("{", "truncated"),
        ("{oops}", "unreadable"),
        ("{" * 3000, "truncated"),
    ],
)
def test_what_is_no_object_is_told_apart(text: str, outcome: str) -> None:
    with pytest.raises(ReplyError) as caught:
        read_object(text)
    assert caught.value.outcome == outcome


@given(st.dictionaries(st.text(), JSON, max_size=4), st.text(alphabet="ab {}[]`\n"))
def test_every_object_survives_being_wrapped(value: dict, prose: str) -> None:
    text = json.dumps(value)
    assert read_object(text) == value
    assert read_object(f"```json\n{text}\n```") == value or "```" in text
    try:
        read_object(prose + text)
    except ReplyError:
        assert "{" in prose


@given(st.text() | JSON.map(json.dumps))
def test_readers_raise_nothing_but_reply_errors(text: str) -> None:
    for read in (
        lambda: read_sub_tasks(text, CONTEXT, 3),
        lambda: read_ranking(text, 3),
        lambda: read_scores(text, 3),
        lambda: read_verdict(text),
        lambda: read_sub_skill(text, CONTEXT),
        lambda: read_predictions(text, CONTEXT),
    ):
        with pytest.raises(ReplyError):
            read()


@given(
    st.dictionaries(
        st.sampled_from(["sub_tasks", "ranking", "scores", "feasible", "sub_skill", "predictions"]), JSON
    )
)
def test_right_fields_with_wrong_values_raise_reply_errors_or_give_values(reply: dict) -> None:
    text = json.dumps(reply)
    for read in (
        lambda: read_sub_tasks(text, CONTEXT, 3),
        lambda: read_ranking(text, 3),
        lambda: read_scores(text, 3),
        lambda: read_verdict(text),
        lambda: read_sub_skill(text, CONTEXT),
        lambda: read_predictions(text, CONTEXT),
    ):
        with contextlib.suppress(ReplyError):
            read()


def skill(entry: object) -> Call:
    return read_sub_skill(json.dumps({"sub_skill": entry}), CONTEXT)


@pytest.mark.parametrize(
    ("entry", "call"),
    [
        ({"name": "Approach", "args": ["Tray|1"]}, Call("Approach", ("Tray|1",))),
        ({"name": "approach", "args": ["letter|1"]}, Call("Approach", ("Letter|1",))),
        ({"name": "Approach", "args": "Letter|1"}, Call("Approach", ("Letter|1",))),
        ({"name": "Approach", "args": {"object": "Letter|1"}}, Call("Approach", ("Letter|1",))),
        ("Approach Letter|1", Call("Approach", ("Letter|1",))),
        ({"name": "WalkBy", "args": [1, "-2.5"]}, Call("WalkBy", (1.0, -2.5))),
        ({"name": "LookAround"}, Call("LookAround")),
        (
            {"name": "Leave", "args": ["Letter|1", "Floor", "room|1"]},
            Call("Leave", ("Letter|1", "Floor", "room|1")),
        ),
    ],
)
def test_legal_sub_skills(entry: object, call: Call) -> None:
    assert skill(entry) == call


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"name": "Fly", "args": []}, "Fly.*Approach <object>"),
        ({"name": "Search", "args": ["room|3"]}, "no sub-skill"),
        ({"name": "Approach", "args": []}, "takes 1"),
        ({"name": "Approach", "args": ["Letter|1", "room|1"]}, "takes 1"),
        ({"name": "Approach", "args": ["Letter|77"]}, r"Letter\|77.*object"),
        ({"name": "Approach", "args": ["room|1"]}, "no known object"),
        ({"name": "Approach", "args": [3]}, "must be a object"),
        ({"name": "WalkTo", "args": ["room|9"]}, "no known room"),
        ({"name": "Leave", "args": ["Letter|1", "Letter|2", "room|1"]}, "no known receptacle"),
        ({"name": "WalkBy", "args": ["east", 1]}, "finite number"),
        ({"name": "WalkBy", "args": [True, 1]}, "finite number"),
        ({"name": "WalkBy", "args": ["nan", 1]}, "finite number"),
        (None, "must look like"),
        ([], "must look like"),
    ],
)
def test_illegal_sub_skills(entry: object, words: str) -> None:
    with pytest.raises(ReplyError, match=words) as caught:
        skill(entry)
    assert caught.value.outcome == "illegal"


def test_ids_are_not_guessed_where_two_differ_by_case_alone() -> None:
    twins = replace(
        CONTEXT,
        objects=(parcel("a|1", "Letter", (0, 0), "room|1"), parcel("A|1", "Letter", (0, 0), "room|1")),
    )
    assert read_sub_skill('{"sub_skill": "Approach a|1"}', twins) == Call("Approach", ("a|1",))
    renamed = replace(
        CONTEXT,
        objects=(parcel("aB|1", "Letter", (0, 0), "room|1"), parcel("Ab|1", "Letter", (0, 0), "room|1")),
    )
    with pytest.raises(ReplyError):
        read_sub_skill('{"sub_skill": "Approach ab|1"}', renamed)


def test_what_is_in_the_hand_is_known() -> None:
    context = replace(CONTEXT, objects=(), holding="Vase|9")
    assert read_sub_skill('{"sub_skill": "Approach Vase|9"}', context).args == ("Vase|9",)


def test_sub_tasks_lose_duplicates_illegal_ones_and_what_is_too_many() -> None:
    entries = [
        {"name": "Deliver", "args": ["Letter|1", "tray", "office"], "reason": "near\nby"},
        {"name": "Deliver", "args": ["Letter|1", "Tray", "Office"]},
        {"name": "Fly", "args": []},
        {"name": "Deliver", "args": ["Letter|1", "top shelf", "Reading Room"]},
        {"name": "Rest"},
    ]
    found = read_sub_tasks(json.dumps({"sub_tasks": entries}), CONTEXT, 2)
    assert [it.sub_task for it in found] == [
        Call("Deliver", ("Letter|1", "Tray", "Office")),
        Call("Deliver", ("Letter|1", "TopShelf", "ReadingRoom")),
    ]
    assert found[0].rationale == "near by"


@pytest.mark.parametrize("entries", [[], [{"name": "Fly"}], None, "Rest", [3]])
def test_no_legal_sub_task(entries: object) -> None:
    with pytest.raises(ReplyError) as caught:
        read_sub_tasks(json.dumps({"sub_tasks": entries}), CONTEXT, 3)
    assert caught.value.outcome == "illegal"


def test_rankings() -> None:
    assert read_ranking('{"ranking": [2, 0, 1]}', 3) == (2, 0, 1)
    assert read_ranking('{"ranking": ["1"]}', 3) == (1, 0, 2)
    for wrong in ([3, 0, 1], [0, 0, 1], [], [0.5], [-1], ["x"], [None]):
        with pytest.raises(ReplyError):
            read_ranking(json.dumps({"ranking": wrong}), 3)


def test_scores() -> None:
    text = '{"scores": [{"index": 1, "score": 7}, {"index": 0, "score": "2.5"}]}'
    assert read_scores(text, 3) == (2.5, 7.0, None)
    for wrong in ([], [{"index": 5, "score": 1}], [{"index": 0}], [7]):
        with pytest.raises(ReplyError):
            read_scores(json.dumps({"scores": wrong}), 3)


@pytest.mark.parametrize(
    ("value", "feasible"), [(True, True), (False, False), ("Yes", True), ("false", False)]
)
def test_verdicts(value: object, feasible: bool) -> None:
    verdict = read_verdict(json.dumps({"feasible": value, "reason": "so\x1eit is"}))
    assert verdict.feasible is feasible
    assert verdict.reason == "so it is"


@pytest.mark.parametrize("value", [None, 1, "perhaps", []])
def test_no_verdict(value: object) -> None:
    with pytest.raises(ReplyError, match="feasible"):
        read_verdict(json.dumps({"feasible": value}))


def test_predictions_keep_known_teammates_and_legal_calls() -> None:
    entries = [
        {
            "teammate": "teammate_1",
            "sub_task": {"name": "Search", "args": ["room|3"]},
            "sub_skill": {"name": "Fly"},
        },
        {"teammate": "a stranger", "sub_task": {"name": "Rest"}},
    ]
    (found,) = read_predictions(json.dumps({"predictions": entries}), CONTEXT)
    assert (found.teammate, found.sub_task, found.sub_skill) == (
        "teammate_1",
        Call("Search", ("room|3",)),
        None,
    )
