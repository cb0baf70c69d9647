"""Whatever a teammate says or is called, a prompt keeps its structure: it is parsed back and compared."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import pytest
from fake_situation import CONTEXT, parcel, receptacle
from hostile_messages import HOSTILE_TEXTS
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.calls import Call
from adhoc.core.chat import ChatMessage
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.plans import Assessment, Candidate, Context, Event, Objection, Prediction
from adhoc.core.values import RoomRecord
from adhoc.llm.offline.reading import read_prompt
from adhoc.prompting.library import shipped_prompts
from adhoc.prompting.stage import StageInput

TEMPLATES = shipped_prompts().names
BREAK = re.compile(r"\r\n|[\n\r\x0b\x0c\x1c-\x1e\x85\u2028\u2029]")
PARTY = r'(?:(?!: )[^"])+'
QUOTED = r'"(?:[^"\\]|\\.)*"'
MESSAGE = re.compile(rf"- step -?\d+, {PARTY} to {PARTY}, \w+: {QUOTED}")
REPLY = re.compile(rf"- {PARTY}: {QUOTED}")
RESERVED = re.compile(r"<\||\|>|<\uff5c|</?s>|\[/?[A-Z_]{2,}\]|<</?SYS>>|<(start|end)_of_turn>")
PLAIN = "plain"

Shape = list[tuple[str, int]]


def shape(prompt: Sequence[ChatMessage]) -> Shape:
    """Roles and headings in order, each with the number of lines that follow."""
    titles, lengths = [], []
    for message in prompt:
        for line in [f"role {message.role}", *BREAK.split(message.content)]:
            if line.startswith(("role ", "## ")):
                titles.append(line)
                lengths.append(0)
            else:
                lengths[-1] += 1
    return list(zip(titles, lengths))


def lines_of(prompt: Sequence[ChatMessage], heading: str) -> list[str]:
    section = prompt[1].content.split(f"## {heading}\n")[1].split("\n## ")[0]
    return [line for line in section.split("\n") if line.startswith("- ")]


def said(text: str) -> tuple[Context, StageInput]:
    """A situation in which teammates say the text, and so does the model of itself."""
    message = Message(MessageKind.DETECTION, text, {"x": text}, None, "teammate_1", 11)
    silent = Message(MessageKind.REPLY, "", {"text": text}, "robot_0", "teammate_2", 12)
    context = replace(CONTEXT, messages=(message, silent, message), history=(Event(3, text), Event(4, text)))
    return context, stage(Call("Search", ("room|3",)), text, (replace(silent, text=f"{text}!"),))


def named(text: str) -> tuple[Context, StageInput]:
    """A situation in which everything that can have a name has this one."""
    call = Call(text, (text, text))
    view = TeammateView(text, room=text, holding=text, sub_task=call, sub_skill=call, explored_rooms=(text,))
    message = Message(MessageKind.REPLY, "hello", {}, text, f"{text}~", 12)
    context = replace(
        CONTEXT,
        me=text,
        room=text,
        holding="Letter|1",
        objects=(
            parcel(text, text, (2.0, 1.0), text, source=text),
            replace(
                parcel("Letter|2", "Letter", (2.0, 1.0), text), receptacle=text, receptacle_category=text
            ),
            receptacle(text, text, (2.0, 1.0), text),
        ),
        rooms=(RoomRecord(text, text, (1.0, 1.0), True, text),),
        teammates=(view,),
        messages=(message,),
        sub_task=call,
        done=(call,),
    )
    return context, stage(call, "it is near", (replace(message, text="yes"),), text)


def stage(call: Call, rationale: str, replies: tuple[Message, ...], found: str = "Cup") -> StageInput:
    return StageInput(
        2,
        (Candidate(call, rationale), Candidate(call, rationale)),
        Candidate(call, rationale),
        replies,
        (Prediction("teammate_1", call, call),),
        call,
        Assessment(False, rationale, found=(found,)),
        {found: call},
        (Objection(found, "robot_0", call, rationale),),
        (f"{found} has joined the team", rationale),
    )


def rendered(template: str, situation: tuple[Context, StageInput]) -> tuple[ChatMessage, ...]:
    return shipped_prompts().render(template, *situation)


def test_the_corpus_is_large() -> None:
    assert len(set(HOSTILE_TEXTS)) >= 100


@pytest.mark.parametrize("template", TEMPLATES)
def test_no_message_changes_the_structure_of_a_prompt(template: str) -> None:
    expected = shape(rendered(template, said(PLAIN)))
    for text in HOSTILE_TEXTS:
        prompt = rendered(template, said(text))
        # Without any words, the payload stands for them, and a reason is left out.
        if text.strip():
            assert shape(prompt) == expected, text[:80]
        assert [it.role for it in prompt] == ["system", "user"]
        assert prompt[0] == rendered(template, said(PLAIN))[0]
        assert all(MESSAGE.fullmatch(line) for line in lines_of(prompt, "Communication messages")), text[:80]
        assert len(lines_of(prompt, "Communication messages")) == 3
        assert not RESERVED.search(prompt[1].content), text[:80]
        assert "9449772114007" not in prompt[1].content


@pytest.mark.parametrize("template", TEMPLATES)
def test_no_name_changes_the_structure_of_a_prompt(template: str) -> None:
    expected = shape(rendered(template, named(PLAIN)))
    for text in HOSTILE_TEXTS:
        prompt = rendered(template, named(text))
        assert shape(prompt) == expected, text[:80]
        assert prompt[0] == rendered(template, named(PLAIN))[0]
        assert all(MESSAGE.fullmatch(line) for line in lines_of(prompt, "Communication messages")), text[:80]
        assert not RESERVED.search(prompt[1].content), text[:80]
        assert "9449772114007" not in prompt[1].content


@pytest.mark.parametrize("text", HOSTILE_TEXTS, ids=lambda text: ascii(text[:20]))
def test_every_reply_is_on_one_quoted_line_under_its_sender(text: str) -> None:
    (line,) = lines_of(rendered("reflect", said(text)), "Replies to your intention")
    assert REPLY.fullmatch(line)
    assert line.startswith("- teammate_2: ")


def test_a_reader_finds_the_same_facts_whatever_is_said() -> None:
    """What the offline reasoner reads is the situation, not the talk about it."""
    expected = read_prompt([it.content for it in rendered("generate", said(PLAIN))])
    for text in HOSTILE_TEXTS:
        facts = read_prompt([it.content for it in rendered("generate", said(text))])
        assert facts._replace(history=(), last="") == expected._replace(history=(), last=""), text[:80]


def test_a_reader_finds_one_thing_for_one_name() -> None:
    """No name adds a field, a receptacle or a room to its line."""
    for text in HOSTILE_TEXTS:
        facts = read_prompt([it.content for it in rendered("generate", named(text))])
        assert (len(facts.rooms), len(facts.objects), len(facts.teammates)) == (1, 2, 1), text[:80]
        assert sum(map(len, facts.receptacles.values())) <= 1, text[:80]
        assert {it.attention for it in facts.objects} == {True}, text[:80]
        assert {it.distance for it in facts.objects} == {1.0}, text[:80]


@given(st.text(min_size=1, max_size=300))
def test_no_text_at_all_changes_the_structure_of_a_prompt(text: str) -> None:
    assert shape(rendered("generate", named(text))) == shape(rendered("generate", named(PLAIN)))
    assert shape(rendered("evaluate", said(f"{text}x"))) == shape(rendered("evaluate", said(PLAIN)))


def test_a_huge_message_takes_no_more_room_than_a_long_one() -> None:
    long, huge = (rendered("generate", said(size * "y"))[1].content for size in (2000, 1_000_000))
    assert long == huge


def test_harmless_text_stays_as_it_is() -> None:
    """Also in other scripts, with accents and with pictures."""
    text = 'Détecté: 杯子 на столе; 3 < 4? \U0001f600 {"a": [1, 2]}'
    line = lines_of(rendered("generate", said(text)), "Communication messages")[0]
    assert line.endswith('Détecté: 杯子 на столе; 3 ‹ 4? \U0001f600 {\\"a\\": [1, 2]}"')
