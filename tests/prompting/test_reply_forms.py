"""Schemas: what they offer is what the reader takes, in words that all providers understand."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import pytest
from fake_situation import CONTEXT, KNOWLEDGE, parcel
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from adhoc.core.calls import Call
from adhoc.core.chat import ChatMessage
from adhoc.core.plans import Candidate, Context
from adhoc.core.replies import ReplyFormat
from adhoc.llm.model import LMRequest
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.prompting.library import shipped_prompts
from adhoc.prompting.reply_forms import (
    predictions_form,
    proposal_form,
    ranking_form,
    scores_form,
    sub_skill_form,
    sub_tasks_form,
    verdict_form,
)
from adhoc.prompting.reply_schema import ANALYSIS, LONGEST_NAME, MAX_ENUM, REASON, text
from adhoc.prompting.stage import StageInput

ALLOWED = {
    "type",
    "properties",
    "required",
    "additionalProperties",
    "items",
    "minItems",
    "maxItems",
    "maxLength",
    "enum",
    "anyOf",
    "$ref",
    "$defs",
}
LLAMA_CPP_REFUSES = 2000
"""Repetitions in a grammar."""
CANDIDATES = tuple(Candidate(Call("Search", (room,))) for room in ("room|3", "room|4"))
STAGES = {
    "generate": StageInput(count=3),
    "gpl_generate": StageInput(count=3),
    "cot": StageInput(count=1),
    "naive": StageInput(count=1),
    "evaluate": StageInput(candidates=CANDIDATES),
    "gpl_score": StageInput(candidates=CANDIDATES),
    "gpl_predict": StageInput(),
    "reflect": StageInput(chosen=CANDIDATES[0]),
    "sub_skill": StageInput(sub_task=CANDIDATES[0].sub_task),
    "direct_sub_skill": StageInput(),
    "negotiate": StageInput(plans={"teammate_1": CANDIDATES[0].sub_task}),
}


def asked(template: str, context: Context = CONTEXT) -> tuple[tuple[ChatMessage, ...], ReplyFormat]:
    """The prompt of a stage and the form of its reply."""
    stage = STAGES[template]
    prompt = shipped_prompts().render(template, context, stage)
    forms = {
        "evaluate": lambda: ranking_form(prompt, len(stage.candidates)),
        "gpl_score": lambda: scores_form(prompt, len(stage.candidates)),
        "gpl_predict": lambda: predictions_form(prompt, context),
        "reflect": lambda: verdict_form(prompt),
        "sub_skill": lambda: sub_skill_form(prompt, context, None),
        "direct_sub_skill": lambda: sub_skill_form(prompt, context, None),
        "negotiate": lambda: proposal_form(prompt, context, stage.plans, None),
    }
    make = forms.get(template, lambda: sub_tasks_form(prompt, context, stage.count, None))
    return prompt, make()


def parts(schema: Any) -> Iterator[Mapping[str, Any]]:
    """Every schema within a schema."""
    if isinstance(schema, Mapping):
        yield schema
        for name in ("items",):
            yield from parts(schema.get(name))
        for name in ("properties", "$defs"):
            for inner in schema.get(name, {}).values():
                yield from parts(inner)
        for inner in schema.get("anyOf", ()):
            yield from parts(inner)


def entry_of(form: ReplyFormat, name: str) -> Mapping[str, Any]:
    """The schema of the call of that name."""
    found = [
        it for it in parts(form.schema) if it.get("properties", {}).get("name", {}).get("enum") == [name]
    ]
    return found[0]


@pytest.mark.parametrize("template", STAGES)
def test_schemas_keep_to_what_strict_modes_understand(template: str) -> None:
    _, form = asked(template)
    Draft202012Validator.check_schema(form.schema)
    assert form.schema["type"] == "object"
    assert json.loads(json.dumps(form.schema)) == form.schema
    for schema in parts(form.schema):
        assert set(schema) <= ALLOWED
        assert schema.get("enum") != []
        if schema.get("type") == "string":
            assert "enum" in schema or 0 < schema["maxLength"] < LLAMA_CPP_REFUSES
        if schema.get("type") == "object":
            assert schema["additionalProperties"] is False
            assert schema["required"] == list(schema["properties"])


@pytest.mark.parametrize("template", STAGES)
def test_the_offline_reasoner_answers_in_the_form_that_the_prompt_describes(template: str) -> None:
    """Prompt, schema and reader agree: none of the three knows of the others."""
    prompt, form = asked(template)
    reply = OfflineReasoner(KNOWLEDGE, 0, 0.0, 0.0, 0.0).complete(LMRequest(prompt, template)).text
    Draft202012Validator(form.schema).validate(json.loads(reply))
    assert form.read(reply).faults == ()
    assert list(form.schema["properties"]) == list(json.loads(reply))


def test_the_reasoning_comes_before_the_answer_where_the_template_asks_for_it() -> None:
    assert next(iter(asked("cot")[1].schema["properties"])) == "analysis"
    assert list(asked("naive")[1].schema["properties"]) == ["sub_tasks"]
    assert list(entry_of(asked("generate")[1], "Rest")["properties"]) == ["name", "args", "reason"]
    assert list(entry_of(asked("naive")[1], "Rest")["properties"]) == ["name", "args"]


@pytest.mark.parametrize(
    ("reply", "is_offered"),
    [
        ({"name": "Approach", "args": ["Letter|1"]}, True),
        ({"name": "Approach", "args": ["Letter|77"]}, False),
        ({"name": "Approach", "args": ["room|1"]}, False),
        ({"name": "Approach", "args": []}, False),
        ({"name": "WalkTo", "args": ["room|4"]}, True),
        ({"name": "WalkTo", "args": ["Letter|1"]}, False),
        ({"name": "WalkBy", "args": [1, -0.5]}, True),
        ({"name": "WalkBy", "args": ["1", 2]}, False),
        ({"name": "Leave", "args": ["Letter|1", "Floor", "room|1"]}, True),
        ({"name": "LookAround", "args": []}, True),
        ({"name": "LookAround", "args": ["room|1"]}, False),
        ({"name": "Search", "args": ["room|1"]}, False),
    ],
)
def test_calls_are_a_tagged_union_with_the_ids_in_the_prompt(reply: Any, is_offered: bool) -> None:
    _, form = asked("sub_skill")
    instance = {"analysis": "", "sub_skill": reply}
    assert Draft202012Validator(form.schema).is_valid(instance) is is_offered


def test_types_of_places_are_open() -> None:
    _, form = asked("naive")
    for room_type in ("Office", "Winter Garden"):
        reply = {"sub_tasks": [{"name": "Deliver", "args": ["Letter|1", "Tray", room_type]}]}
        Draft202012Validator(form.schema).validate(reply)


def test_as_many_sub_tasks_as_were_asked_for() -> None:
    rest = {"name": "Rest", "args": []}
    with pytest.raises(ValidationError):
        Draft202012Validator(asked("naive")[1].schema).validate({"sub_tasks": [rest, rest]})


def test_the_reader_takes_the_same_ids_as_the_schema() -> None:
    many = tuple(parcel(f"Letter|{i}", "Letter", (i, 0.0), "room|1") for i in range(60))
    prompt, form = asked("sub_skill", replace(CONTEXT, objects=many))
    offered = form.schema["$defs"]["object"]["enum"]
    assert 0 < len(offered) < len(many)
    for letter in many:
        text = json.dumps({"sub_skill": {"name": "Approach", "args": [letter.id]}})
        if letter.id in offered:
            assert letter.id in prompt[1].content
            assert form.read(text).value == Call("Approach", (letter.id,))
        else:
            with pytest.raises(Exception, match="no object of those listed"):
                form.read(text)


def test_what_an_example_names_is_not_shown() -> None:
    many = tuple(parcel(f"Letter|{i}", "Letter", (i, 0.0), "room|1") for i in range(60))
    example = {"sub_skill": 'Answer: {"sub_skill": {"name": "Approach", "args": ["Letter|59"]}}'}
    prompt, form = asked(
        "sub_skill", replace(CONTEXT, objects=many, task=replace(CONTEXT.task, examples=example))
    )
    assert "Letter|59" in prompt[0].content
    assert "Letter|59" not in prompt[1].content
    assert "Letter|59" not in form.schema["$defs"]["object"]["enum"]


def test_a_call_for_which_nothing_is_known_is_not_offered() -> None:
    nowhere = replace(CONTEXT, rooms=(), objects=(), messages=(), teammates=())
    _, form = asked("sub_skill", nowhere)
    names = [it["properties"]["name"]["enum"][0] for it in form.schema["properties"]["sub_skill"]["anyOf"]]
    assert names == ["WalkBy", "Rest", "LookAround"]


def test_more_ids_than_schemas_may_enumerate_are_left_open() -> None:
    rooms = tuple(replace(CONTEXT.rooms[0], id=f"room|{i}") for i in range(MAX_ENUM + 1))
    _, form = asked("sub_skill", replace(CONTEXT, rooms=rooms))
    assert entry_of(form, "WalkTo")["properties"]["args"]["items"] == text(LONGEST_NAME)
    assert "room" not in form.schema["$defs"]
    assert form.read('{"sub_skill": "WalkTo room|250"}').value.args == ("room|250",)


def test_what_is_longer_than_the_schema_allows_is_read_all_the_same() -> None:
    _, form = asked("generate")
    rest = {"name": "Rest", "args": [], "reason": "y" * (REASON + 1)}
    reply = {"analysis": "y" * (ANALYSIS + 1), "sub_tasks": [rest]}
    assert not Draft202012Validator(form.schema).is_valid(reply)
    assert form.read(json.dumps(reply)).value[0].sub_task == Call("Rest")
