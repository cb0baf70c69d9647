"""Reading replies: lenient about form, strict about content, and everything dropped is a fault."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Sequence
from dataclasses import replace

import pytest
from fake_situation import CONTEXT, parcel
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.calls import Call, CallSpec, ParameterKind
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ReplyError
from adhoc.core.plans import Candidate, Context
from adhoc.core.replies import Reading
from adhoc.prompting.known import Known, told_by_teammates
from adhoc.prompting.library import shipped_prompts
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
BRIEF = CONTEXT.task
KNOWN = Known(CONTEXT, shipped_prompts().render("generate", CONTEXT))


def known_in(context: Context) -> Known:
    return Known(context, shipped_prompts().render("generate", context))


def sub_tasks(*entries: object, refused: Sequence[str] = (), count: int = 3) -> Reading:
    def refusal(call: Call) -> str | None:
        return f"may not {call.name}" if call.name in refused else None

    return read_sub_tasks(json.dumps({"sub_tasks": entries}), BRIEF, KNOWN, count, refusal)


READERS = (
    lambda text: read_sub_tasks(text, BRIEF, KNOWN, 3, None),
    lambda text: read_ranking(text, 3),
    lambda text: read_scores(text, 3),
    read_verdict,
    lambda text: read_sub_skill(text, BRIEF, KNOWN, None),
    lambda text: read_predictions(text, BRIEF, KNOWN),
)


@given(st.text() | JSON.map(json.dumps))
def test_readers_raise_nothing_but_reply_errors(text: str) -> None:
    for read in READERS:
        with pytest.raises(ReplyError):
            read(text)


@given(
    st.dictionaries(
        st.sampled_from(["sub_tasks", "ranking", "scores", "feasible", "sub_skill", "predictions"]), JSON
    )
)
def test_right_fields_with_wrong_values_raise_reply_errors_or_give_values(reply: dict) -> None:
    text = json.dumps(reply)
    for read in READERS:
        with contextlib.suppress(ReplyError):
            read(text)


def skill(entry: object) -> Call:
    return read_sub_skill(json.dumps({"sub_skill": entry}), BRIEF, KNOWN, None).value


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
    ("entry", "outcome", "words"),
    [
        ({"name": "Fly", "args": []}, "illegal", "Fly.*Approach <object>"),
        ({"name": "Search", "args": ["room|3"]}, "illegal", "no sub-skill"),
        ({"name": "Approach", "args": []}, "illegal", "takes 1"),
        ({"name": "Approach", "args": ["Letter|1", "room|1"]}, "illegal", "takes 1"),
        ({"name": "Approach", "args": ["Letter|77"]}, "unknown id", r"Letter\|77.*no object"),
        ({"name": "Approach", "args": ["room|1"]}, "unknown id", "no object"),
        ({"name": "Approach", "args": [3]}, "illegal", "name of a object"),
        ({"name": "Approach", "args": [["Letter|1"]]}, "illegal", "name of a object"),
        ({"name": "WalkTo", "args": ["room|9"]}, "unknown id", "no room"),
        ({"name": "Leave", "args": ["Letter|1", "Letter|2", "room|1"]}, "unknown id", "no receptacle"),
        ({"name": "WalkBy", "args": ["east", 1]}, "illegal", "finite number"),
        ({"name": "WalkBy", "args": [True, 1]}, "illegal", "finite number"),
        ({"name": "WalkBy", "args": ["nan", 1]}, "illegal", "finite number"),
        ({"name": "WalkBy", "args": ["1e999", 1]}, "illegal", "finite number"),
        (None, "illegal", "must look like"),
        ([], "illegal", "must look like"),
        ("  ", "illegal", "must look like"),
    ],
)
def test_illegal_sub_skills(entry: object, outcome: str, words: str) -> None:
    with pytest.raises(ReplyError, match=words) as caught:
        skill(entry)
    assert caught.value.outcome == outcome


def test_what_this_robot_may_not_do_is_refused() -> None:
    text = json.dumps({"sub_skill": "Grab Letter|1"})
    with pytest.raises(ReplyError, match=r"Grab Letter\|1: has no hand") as caught:
        read_sub_skill(text, BRIEF, KNOWN, lambda call: "has no hand")
    assert caught.value.outcome == "illegal"


def test_error_texts_are_bounded() -> None:
    with pytest.raises(ReplyError) as caught:
        skill({"name": "x" * 5000, "args": []})
    assert len(str(caught.value)) < 600


def test_ids_are_not_guessed_where_two_differ_by_case_alone() -> None:
    letters = [parcel(id, "Letter", (0, 0), "room|1") for id in ("aB|1", "Ab|1")]
    known = known_in(replace(CONTEXT, objects=tuple(letters)))
    assert read_sub_skill('{"sub_skill": "Approach Ab|1"}', BRIEF, known, None).value.args == ("Ab|1",)
    with pytest.raises(ReplyError):
        read_sub_skill('{"sub_skill": "Approach ab|1"}', BRIEF, known, None)


def test_what_is_in_the_hand_is_known() -> None:
    known = known_in(replace(CONTEXT, objects=(), holding="Vase|9"))
    assert read_sub_skill('{"sub_skill": "Approach Vase|9"}', BRIEF, known, None).value.args == ("Vase|9",)


class TestKnown:
    def test_an_id_that_the_prompt_does_not_show_is_not_known(self) -> None:
        known = Known(
            CONTEXT, (ChatMessage("user", "I see Letter|11, my Letter|2; (Letter|3). And Letter|4|5?"),)
        )
        assert [known.find(ParameterKind.OBJECT, it) for it in ("Letter|1", "Letter|2", "letter|3")] == [
            None,
            "Letter|2",
            "Letter|3",
        ]
        assert known.ids(ParameterKind.OBJECT) == ("Letter|2", "Letter|3")
        assert known.ids(ParameterKind.ROOM) == ()
        assert known.ids(ParameterKind.RECEPTACLE) == ("Floor",)
        assert known.ids(ParameterKind.ROOM_TYPE) is None

    def test_an_id_is_known_as_the_prompt_writes_it(self) -> None:
        strange = parcel("a;b\n|1", "Letter", (0, 0), "room|1")
        known = known_in(replace(CONTEXT, objects=(strange,)))
        assert known.ids(ParameterKind.OBJECT) == ("a,b |1",)
        assert known.find(ParameterKind.OBJECT, "a,b |1") == strange.id

    def test_ids_that_look_alike_in_the_prompt_name_nothing(self) -> None:
        twins = tuple(parcel(id, "Letter", (0, 0), "room|1") for id in ("a;|1", "a,|1"))
        assert known_in(replace(CONTEXT, objects=twins)).ids(ParameterKind.OBJECT) == ()

    def test_what_a_teammate_told_is_known_of_the_teammate_alone(self) -> None:
        """Also where a sub-skill has the name of the sub-task."""
        told = replace(CONTEXT.teammates[0], sub_task=Call("Search", ("room|9",)))
        brief = replace(BRIEF, sub_skills=(*BRIEF.sub_skills, CallSpec("Search", (), "Look around.")))
        context = replace(CONTEXT, teammates=(told,), task=brief)
        prompt = shipped_prompts().render("gpl_predict", context)
        own, theirs = Known(context, prompt), Known(context, prompt, told_by_teammates(context))
        assert own.find(ParameterKind.ROOM, "room|9") is None
        assert theirs.find(ParameterKind.ROOM, "room|9") == "room|9"

    def test_what_the_limits_leave_out_is_not_known(self) -> None:
        many = tuple(parcel(f"Letter|{i}", "Letter", (i, 0.0), "room|1") for i in range(100))
        shown = known_in(replace(CONTEXT, objects=many)).ids(ParameterKind.OBJECT)
        assert shown is not None
        assert 0 < len(shown) < 100


class TestSubTasks:
    DELIVERY = Call("Deliver", ("Letter|1", "Tray", "Office"))

    def test_duplicates_and_what_is_not_allowed_are_dropped_with_a_fault(self) -> None:
        reading = sub_tasks(
            {"name": "Deliver", "args": ["Letter|1", "tray", "office"], "reason": "near\nby"},
            {"name": "Deliver", "args": ["Letter|1", "Tray", "Office"]},
            {"name": "Fly", "args": []},
            {"name": "Search", "args": ["room|9"]},
            {"name": "Rest"},
            refused=["Rest"],
        )
        assert reading.value == (Candidate(self.DELIVERY, "near by"),)
        assert [it.outcome for it in reading.faults] == ["duplicate", "illegal", "unknown id", "illegal"]
        assert "may not Rest" in reading.faults[-1].detail

    def test_new_types_of_places_are_legal_and_what_is_too_many_is_no_fault(self) -> None:
        reading = sub_tasks(
            {"name": "Deliver", "args": ["Letter|1", "top shelf", "Reading Room"]}, "Rest", count=1
        )
        assert [it.sub_task.args for it in reading.value] == [("Letter|1", "TopShelf", "ReadingRoom")]
        assert reading.faults == ()

    @pytest.mark.parametrize(
        ("entries", "outcome"),
        [
            ([], "illegal"),
            ([{"name": "Fly"}], "illegal"),
            ([3], "illegal"),
            (["Rest"], "illegal"),
            (["Search room|9", "Search room|8"], "unknown id"),
            (["Search room|9", "Fly"], "illegal"),
            (["Fly"] * 1000, "illegal"),
        ],
    )
    def test_nothing_left(self, entries: list[object], outcome: str) -> None:
        with pytest.raises(ReplyError) as caught:
            sub_tasks(*entries, refused=["Rest"])
        assert caught.value.outcome == outcome

    @pytest.mark.parametrize("value", [None, "Rest", 3])
    def test_no_list(self, value: object) -> None:
        with pytest.raises(ReplyError, match="needs a list"):
            read_sub_tasks(json.dumps({"sub_tasks": value}), BRIEF, KNOWN, 3, None)


def test_rankings() -> None:
    assert read_ranking('{"ranking": [2, 0, 1]}', 3).value == (2, 0, 1)
    assert read_ranking('{"ranking": ["1"]}', 3).value == (1, 0, 2)


@pytest.mark.parametrize(
    ("ranking", "outcome"),
    [
        ([3, 0, 1], "unknown id"),
        ([-1], "unknown id"),
        ([0.5], "unknown id"),
        ([0, 0, 1], "duplicate"),
        ([], "illegal"),
        (["x"], "illegal"),
        ([None], "illegal"),
        ([True, 0], "illegal"),
    ],
)
def test_no_rankings(ranking: list[object], outcome: str) -> None:
    with pytest.raises(ReplyError) as caught:
        read_ranking(json.dumps({"ranking": ranking}), 3)
    assert caught.value.outcome == outcome


def test_scores() -> None:
    text = '{"scores": [{"index": 1, "score": 7}, {"index": 0, "score": "2.5"}]}'
    assert read_scores(text, 3).value == (2.5, 7.0, None)
    twice = [{"index": 0, "score": 1}, {"index": 0, "score": 9}]
    for wrong in ([], [{"index": 5, "score": 1}], [{"index": 0}], [7], twice):
        with pytest.raises(ReplyError):
            read_scores(json.dumps({"scores": wrong}), 3)


@pytest.mark.parametrize(
    ("value", "feasible"), [(True, True), (False, False), ("Yes", True), ("false", False)]
)
def test_verdicts(value: object, feasible: bool) -> None:
    verdict = read_verdict(json.dumps({"feasible": value, "reason": "so\x1eit is"})).value
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
        {"teammate": "teammate_2", "sub_task": None},
        {"teammate": "Teammate_1", "sub_task": "Rest"},
        {"teammate": "a stranger", "sub_task": {"name": "Rest"}},
        "nobody",
    ]
    reading = read_predictions(json.dumps({"predictions": entries}), BRIEF, KNOWN)
    assert [(it.teammate, it.sub_task, it.sub_skill) for it in reading.value] == [
        ("teammate_1", Call("Search", ("room|3",)), None),
        ("teammate_2", None, None),
    ]
    assert [it.outcome for it in reading.faults] == ["illegal", "duplicate", "unknown id", "unknown id"]
    with pytest.raises(ReplyError) as caught:
        read_predictions('{"predictions": [{"teammate": "a stranger"}]}', BRIEF, KNOWN)
    assert caught.value.outcome == "unknown id"


def test_a_type_that_a_teammate_makes_up_does_not_stand_for_one_that_looks_alike() -> None:
    """Whatever the order, which for sets of texts changes from process to process."""
    made_up = replace(CONTEXT.objects[0], id="x", category="Tr ay")
    known = known_in(replace(CONTEXT, objects=(*CONTEXT.objects, made_up)))
    kind = ParameterKind.RECEPTACLE_TYPE
    assert [known.find(kind, it) for it in ("Tray", "Tr ay", "tray")] == ["Tray", "Tr ay", "Tray"]
    assert known_in(CONTEXT).find(kind, "t_ray") == "Tray"
