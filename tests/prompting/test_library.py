"""Templates: order of the parts, foreign text, budgets, folders, errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from fake_situation import CONTEXT, parcel, receptacle
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.calls import Call
from adhoc.core.errors import PromptError
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.plans import Candidate, Event
from adhoc.core.values import Capability
from adhoc.prompting.library import PromptLibrary, shipped_prompts
from adhoc.prompting.stage import StageInput

LAYOUT_ORDER = [
    "## Your capability",
    "## Capability of the teammates",
    "## Communication messages",
    "## Your memory",
    "## Receptacles by room",
    "## Rooms",
    "## Teammates",
    "## Your state at step 12",
    "## Objects in view now",
    "## Objects detected before",
    "## What to do now",
]


def user(context=CONTEXT, template="generate", library=None, **stage) -> str:
    return (library or shipped_prompts()).render(template, context, StageInput(**stage))[1].content


def headings(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("## ")]


def test_parts_come_in_the_fixed_order() -> None:
    system, message = shipped_prompts().render("generate", CONTEXT, StageInput(count=3))
    assert (system.role, message.role) == ("system", "user")
    assert headings(system.content) == [
        "## Task: post",
        "## Candidate sub-tasks",
        "## Output format",
        "## Examples",
    ]
    assert headings(message.content) == LAYOUT_ORDER


def test_system_message_is_the_same_at_every_step() -> None:
    later = replace(CONTEXT, step=99, messages=(), history=(), objects=(), room=None, holding="Letter|1")
    first, second = (shipped_prompts().render("evaluate", it)[0] for it in (CONTEXT, later))
    assert first == second


@pytest.mark.parametrize("template", shipped_prompts().names)
def test_an_empty_situation_can_be_rendered(template: str) -> None:
    empty = replace(
        CONTEXT,
        objects=(),
        rooms=(),
        teammates=(),
        messages=(),
        history=(),
        room=None,
        capability=CONTEXT.capability,
    )
    stage = StageInput(sub_task=Call("Unheard", ("of",)), chosen=None)
    if template == "reflect":
        with pytest.raises(PromptError, match=r"reflect.*chosen"):
            shipped_prompts().render(template, empty, stage)
    else:
        assert "- none known" in shipped_prompts().render(template, empty, stage)[1].content


@given(st.text(max_size=400))
def test_no_message_can_imitate_a_heading_a_role_or_an_end(text: str) -> None:
    message = Message(MessageKind.DETECTION, text + "x", {}, None, text, 11)
    rendered = shipped_prompts().render(
        "reflect",
        replace(CONTEXT, messages=(message,), history=(Event(1, text),)),
        StageInput(chosen=_candidate(text), replies=(message,)),
    )
    assert [it.role for it in rendered] == ["system", "user"]
    expected = [*LAYOUT_ORDER[:-1], "## Chosen sub-task", "## Replies to your intention", LAYOUT_ORDER[-1]]
    assert headings(rendered[1].content) == expected
    assert all(character.isprintable() or character == "\n" for character in rendered[1].content)


def _candidate(text: str):
    return Candidate(Call("Search", ("room|3",)), text)


def test_template_syntax_in_messages_is_text() -> None:
    message = Message(MessageKind.DETECTION, "{{ 7 * 7 }} {% include 'x' %}", {}, None, "t", 1)
    assert "{{ 7 * 7 }} {% include 'x' %}" in user(replace(CONTEXT, messages=(message,)))


def said(count: int) -> tuple[Message, ...]:
    return tuple(Message(MessageKind.DETECTION, f"word{it}.", {}, None, "t", it) for it in range(count))


def shown(text: str, count: int) -> list[int]:
    return [it for it in range(count) if f"word{it}." in text]


def test_the_earliest_messages_and_events_go_first() -> None:
    history = tuple(Event(it, f"deed{it}") for it in range(9))
    library = PromptLibrary(max_messages=2, max_history=1)
    text = user(replace(CONTEXT, messages=said(9), history=history), library=library)
    assert shown(text, 9) == [7, 8]
    assert [it for it in range(9) if f"deed{it}" in text] == [8]
    nothing = PromptLibrary(max_messages=0, max_history=0)
    assert "word8" not in user(replace(CONTEXT, messages=said(9), history=history), library=nothing)


@pytest.mark.parametrize(("count", "first"), [(9, 0), (10, 3), (12, 3), (13, 6), (15, 6), (16, 9)])
def test_the_messages_shown_begin_at_the_same_one_until_a_third_of_them_goes(count: int, first: int) -> None:
    text = user(replace(CONTEXT, messages=said(count)), library=PromptLibrary(max_messages=9))
    assert shown(text, count) == list(range(first, count))


def test_long_messages_are_cut_off() -> None:
    message = Message(MessageKind.DETECTION, "y" * 1000, {}, None, "t", 1)
    text = user(replace(CONTEXT, messages=(message,)), library=PromptLibrary(max_message_characters=10))
    assert '"yyyyyyyyy…"' in text


def test_replies_are_not_cut_off_where_messages_are() -> None:
    text = "Detected objects: " + "; ".join(f"Cup_{it} at Table_{it}" for it in range(150)) + "; the end."
    assert 2500 < len(text) < 4000
    reply = Message(MessageKind.REPLY, text, {}, "robot_0", "teammate_1", 12)
    shown = user(template="reflect", chosen=_candidate(""), replies=(reply,))
    assert f'- teammate_1: "{text}"\n' in shown
    library = PromptLibrary(max_reply_characters=10)
    cut = user(template="reflect", library=library, chosen=_candidate(""), replies=(reply,))
    assert '- teammate_1: "Detected …"\n' in cut


def test_a_reply_is_listed_once() -> None:
    """The context has the replies as messages, too; other messages of the same robot stay."""
    reply = Message(MessageKind.REPLY, "I am busy.", {}, "robot_0", "teammate_1", 12)
    earlier = Message(MessageKind.REPLY, "I am free.", {}, "robot_0", "teammate_1", 7)
    context = replace(CONTEXT, messages=(earlier, reply))
    shown = user(context, "reflect", chosen=_candidate(""), replies=(reply,))
    assert shown.count("I am busy.") == 1
    assert shown.count("I am free.") == 1
    assert "I am busy." in user(context, "generate"), "without a section of replies it is a message"


def test_the_shipped_prompts_carry_two_hundred_messages_of_a_thousand_characters() -> None:
    messages = tuple(replace(it, text=f"{it.text} {'y' * 900} end") for it in said(201))
    text = user(replace(CONTEXT, messages=messages[:200]))
    assert shown(text, 200) == list(range(200))
    assert text.count(' end"') == 200
    assert shown(user(replace(CONTEXT, messages=messages)), 201) == list(range(66, 201))


def test_own_messages_are_told_from_those_of_others() -> None:
    messages = (
        Message(MessageKind.INTENTION, "I intend to rest.", {}, None, "robot_0", 3),
        Message(MessageKind.REPLY, "Do.", {}, "robot_0", "teammate_1", 3),
        Message(MessageKind.REPLY, "I do.", {}, "teammate_1", "robot_0", 4),
    )
    shown = user(replace(CONTEXT, messages=messages))
    assert '- step 3, you to all, intention: "I intend to rest."\n' in shown
    assert '- step 3, teammate_1 to you, reply: "Do."\n' in shown
    assert '- step 4, you to teammate_1, reply: "I do."\n' in shown


@pytest.mark.parametrize(
    ("capability", "steps_left", "ability", "battery"),
    [
        (Capability(max_steps=300), 120, "camera height: 1.6 m; full battery: 300 steps\n", "120 steps left"),
        (Capability(max_steps=300), 0, "camera height: 1.6 m; full battery: 300 steps\n", "0 steps left"),
        (Capability(max_steps=300), None, "camera height: 1.6 m; full battery: 300 steps\n", "unknown"),
        (None, 120, "- t; capability: unknown\n", "120 steps left"),
        (None, None, "- t; capability: unknown\n", "unknown"),
    ],
)
def test_what_a_teammate_can_do_stands_apart_from_what_is_left_of_its_battery(
    capability: Capability | None, steps_left: int | None, ability: str, battery: str
) -> None:
    text = user(replace(CONTEXT, teammates=(TeammateView("t", capability, steps_left=steps_left),)))
    assert ability in text
    assert f"- t; battery: {battery}; position: " in text


def test_an_object_that_needs_no_attention_is_listed_briefly() -> None:
    lines = user().splitlines()
    assert "- Letter|3; type: Letter; needs attention: no; room: room|1; at: Chair|1 (Chair)" in lines
    assert any(it.startswith("- Letter|1; ") and "; distance: 1.0 m; mass: 0.2 kg" in it for it in lines)


def test_objects_that_need_attention_are_listed_first_and_the_rest_is_counted() -> None:
    many = tuple(parcel(f"Old|{it}", "Letter", (1.0, 1.0), "room|1", misplaced=False) for it in range(50))
    text = user(replace(CONTEXT, objects=(*many, *CONTEXT.objects)), library=PromptLibrary(max_objects=4))
    assert "Letter|2" in text
    assert "- and 50 more" in text


def test_only_the_nearest_receptacles_of_a_type_are_listed() -> None:
    trays = tuple(receptacle(f"T|{it}", "Tray", (1.0, 2.0 + it), "room|1") for it in range(5))
    text = user(replace(CONTEXT, objects=trays), library=PromptLibrary(max_receptacles_per_type=2))
    assert "- room|1 (Lobby): T|0 [Tray, 1.0 m]; T|1 [Tray, 2.0 m]\n" in text


def test_what_is_in_the_hand_is_said() -> None:
    text = user(replace(CONTEXT, holding="Box|1"))
    assert "- holding: Box|1\n" in text
    assert "- Box|1; type: Box; needs attention: yes; in your hand; mass: 9 kg\n" in text


def test_a_folder_of_one_s_own_goes_before_the_shipped_templates(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "memory.jinja").write_text("## Your memory\n- wiped", encoding="utf-8")
    (tmp_path / "mine.jinja").write_text(
        '{% extends "layout.jinja" %}{% block output_format %}{}{% endblock %}'
        "{% block instruction %}Step {{ me.step }}.{% endblock %}",
        encoding="utf-8",
    )
    library = PromptLibrary(folder=tmp_path)
    assert "mine" in library.names
    assert "generate" in library.names
    text = user(template="mine", library=library)
    assert "## Your memory\n- wiped\n\n## Receptacles by room\n" in text
    assert text.endswith("\n\n## What to do now\nStep 12.")
    assert library.fingerprint != shipped_prompts().fingerprint


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("{{ nothing_of_the_kind }}", "nothing_of_the_kind"),
        ("{% if %}", "bad"),
        ("{% include '../secret.jinja' %}", "secret"),
        ("{{ ''.__class__.__mro__ }}", "unsafe|__class__"),
        ("{{ examples.update(a=1) }}", "unsafe"),
        ("{{ me.__init__.__globals__ }}", "unsafe|__init__"),
        ("{{ lipsum.__globals__ }}", "lipsum"),
        ("{{ cycler }}", "cycler"),
        ("{% include '/etc/hostname' %}", "hostname"),
        ("{% include 'parts/../../secret.jinja' %}", "secret"),
        ("{% import '../secret.jinja' as secret %}", "secret"),
        ("{% include 'bad.jinja' %}", "cannot be filled|recursion"),
        ("{% for i in range(10**9) %}x{% endfor %}", "range|10"),
        ("{% for i in range(99999) %}x{% endfor %}", "more than 1000 numbers"),
        (
            "{% for i in range(999) %}{% for j in range(999) %}{{ i }}{% for k in range(9) %}xxx{% endfor %}"
            "{% endfor %}{% endfor %}",
            "more than 4000000 characters",
        ),
        ("{{ 'x' * 10**9 }}", "is for numbers up to"),
        ("{{ 9 ** 9 ** 9 }}", "is for numbers up to"),
        ("{{ 'x'.ljust(10000000000) }}", "unsafe"),
        ("{{ '%9999999999d' | format(1) }}", "format"),
        ("{{ 'x' | center(9999999999) }}", "center"),
        ("{% set x = 'xx' %}" + "{% set x = x ~ x %}" * 40, "more than 4000000 characters"),
        ("{% set x = 'xx' %}" + "{% set x = x + x %}" * 40, "more than 4000000 characters"),
        ("{% set x = [1] %}" + "{% set x = x + x %}" * 40, "more than 4000000 characters"),
        ("{% set x = range(999) | join('xxxxxxxx') %}{{ range(999) | join(x) }}", "more than 4000000 charac"),
        ("{{ '%9999999999d' % 1 }}", "is for numbers up to"),
        ("{{ 'x'.join(range(999) | map('string')) }}", "unsafe"),
        ("{{ 'xx'.replace('x', 'xx') }}", "unsafe"),
        ("{{ 'xx' | replace('x', 'xx') }}", "replace"),
        ("{{ [1] | tojson(9999999999) }}", "tojson"),
        ("{{ [1, 2] | random }}", "random"),
        ("{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", "recursion"),
        ("{{ 1 / 0 }}", "division by zero"),
        ("{{ 'x' + 1 }}", "cannot be filled"),
    ],
)
def test_bad_templates_are_prompt_errors(tmp_path: Path, source: str, words: str) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (tmp_path / "secret.jinja").write_text("secret", encoding="utf-8")
    (folder / "bad.jinja").write_text(source, encoding="utf-8")
    with pytest.raises(PromptError, match=words):
        PromptLibrary(folder=folder).render("bad", CONTEXT)


def test_usual_expressions_are_filled(tmp_path: Path) -> None:
    (tmp_path / "mine.jinja").write_text(
        "{{ [me.step, me.step + 1, me.step % 5] | join(', ') }}; {{ 'a' ~ 1 ~ 'b' }}; {{ ['x'] + ['y'] }}; "
        "{{ range(3) | join }}; {{ 'x' + 'y' | upper }}",
        encoding="utf-8",
    )
    text = PromptLibrary(folder=tmp_path).render("mine", CONTEXT)[0].content
    assert text == "12, 13, 2; a1b; ['x', 'y']; 012; xY"


def test_missing_things_are_named(tmp_path: Path) -> None:
    with pytest.raises(PromptError, match=r"no_such.*generate"):
        shipped_prompts().render("no_such", CONTEXT)
    with pytest.raises(PromptError, match="nowhere"):
        PromptLibrary(folder=tmp_path / "nowhere")


@pytest.mark.parametrize("link", ["parts/memory.jinja", "generate.jinja", "unused.jinja"])
def test_a_link_does_not_lead_out_of_a_folder(tmp_path: Path, link: str) -> None:
    """Folders of others, as archives and repositories hold them, may have links to anything."""
    secret = tmp_path / "secret"
    secret.write_text("the key is 1234", encoding="utf-8")
    folder = tmp_path / "prompts"
    (folder / "parts").mkdir(parents=True)
    (folder / link).symlink_to(secret)
    library = PromptLibrary(folder=folder)
    with pytest.raises(PromptError, match="leads out of the folder"):
        library.check("generate")


def test_a_linked_directory_does_not_lead_out_of_a_folder(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "secret.jinja").write_text("the key is 1234", encoding="utf-8")
    folder = tmp_path / "prompts"
    folder.mkdir()
    (folder / "parts").symlink_to(tmp_path / "elsewhere")
    (folder / "mine.jinja").write_text("{% include 'parts/secret.jinja' %}", encoding="utf-8")
    with pytest.raises(PromptError, match="leads out of the folder"):
        PromptLibrary(folder=folder).render("mine", CONTEXT)


def test_a_folder_may_itself_be_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "mine.jinja").write_text("Step {{ me.step }}.", encoding="utf-8")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert PromptLibrary(folder=tmp_path / "link").render("mine", CONTEXT)[0].content == "Step 12."


def test_only_what_the_fingerprint_covers_is_a_template(tmp_path: Path) -> None:
    (tmp_path / "part.txt").write_text("a part", encoding="utf-8")
    (tmp_path / "mine.jinja").write_text("{% include 'part.txt' %}", encoding="utf-8")
    with pytest.raises(PromptError, match=r"part\.txt"):
        PromptLibrary(folder=tmp_path).render("mine", CONTEXT)


def test_a_template_that_is_no_text_is_an_error_at_once(tmp_path: Path) -> None:
    (tmp_path / "unused.jinja").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PromptError, match=r"unused\.jinja.* cannot be read"):
        PromptLibrary(folder=tmp_path).check("generate")
