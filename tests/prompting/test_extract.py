"""Finding an object in a reply: what is forgiven, what is not, and what is told of it."""

from __future__ import annotations

import contextlib
import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ReplyError
from adhoc.prompting.extract import MAX_CHARACTERS, read_object

NUMBERS = st.integers(-(10**9), 10**9) | st.floats(allow_nan=False, allow_infinity=False)


def objects(text: st.SearchStrategy[str]) -> st.SearchStrategy[dict]:
    values = st.recursive(
        st.none() | st.booleans() | NUMBERS | text,
        lambda inner: st.lists(inner, max_size=4) | st.dictionaries(text, inner, max_size=4),
        max_leaves=12,
    )
    return st.dictionaries(text, values, max_size=4)


@pytest.mark.parametrize(
    "text",
    [
        '{"a": [1, 2]}',
        ' \n{"a": [1, 2]}\n',
        'Here it is:\n```json\n{"a": [1, 2]}\n```\nHope that helps {you}. Not {"a": 3}.',
        '```\n{"a": [1, 2,],}\n```',
        'Let me think {about it}. {"a": [1, 2]} Done.',
        'First {"a": 0}, no: {"a": [1, 2]}',
        '{"a": 0}' * 62 + '{"a": [1, 2]}',
        "{'a': [1, 2]}",
        "{a: [1, 2]}",
        '{"a": /* both */ [1, 2], // that is all\n}',
        '{"a": [01, +2]} # a comment',
        '{"a" : [1.0, 2e0]}',
    ],
)
def test_an_object_is_found(text: str) -> None:
    assert read_object(text) == {"a": [1, 2]}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (
            '{"a": True, "b": [None, False], "c": "True, or\nnot"}',
            {"a": True, "b": [None, False], "c": "True, or\nnot"},
        ),
        ("""{'a': 'I don't know', 'b': "it's"}""", {"a": "I don't know", "b": "it's"}),
        ("""{'a': 'say "no", or \\'yes\\'', 'b': 1}""", {"a": "say \"no\", or 'yes'", "b": 1}),
        (r'{"a": "\_x \u00e9 \\ \n"}', {"a": "_x é \\ \n"}),
        ('{"a": "```{}``` and // no comment", "b": 1}', {"a": "```{}``` and // no comment", "b": 1}),
        ('{"a": ' + "9" * 30 + "}", {"a": 1e30}),
        ("{}", {}),
    ],
)
def test_what_is_forgiven(text: str, value: dict) -> None:
    assert read_object(text) == value


@pytest.mark.parametrize(
    ("text", "outcome"),
    [
        ("", "empty"),
        ("  \n", "empty"),
        ("I would rather not.", "unreadable"),
        ("[1, 2]", "unreadable"),
        ("<html><body>502 Bad Gateway</body></html>", "unreadable"),
        ('{"sub_tasks": [{"name": "Search", "args": ["room|3"]}, {"na', "truncated"),
        ('{"analysis": "hm', "truncated"),
        ("{'analysis': 'I don't", "truncated"),
        ('{"a": 1, /* so', "truncated"),
        ('{"a": 1} No, wait: {"a": [1,', "truncated"),
        ("{", "truncated"),
        ("{oops}", "unreadable"),
        ("{" * 3000, "truncated"),
        ('{"a":' * 10_000, "unreadable"),
        ('{"a":' + "[" * 10_000 + "]" * 10_000 + "}", "unreadable"),
        ('{"a": NaN}', "unreadable"),
        ('{"a": [-Infinity]}', "unreadable"),
        ('{"a": 1e999}', "unreadable"),
        ('{"a": ' + "9" * 5000 + "}", "unreadable"),
        ('{"a": 1 2}', "unreadable"),
        ('{"a": [}]', "unreadable"),
        ('{"a": 1,,}', "unreadable"),
        ('{"a": 1, "a": 2}', "duplicate"),
        ('{"b": {"a": 1, "a": 1}}', "duplicate"),
        ("x" * 1_000_000, "unreadable"),
        ('{"a": "' + "x" * 1_000_000 + '"}', "unreadable"),
        ('{"a": 1}' * 125_000, "unreadable"),
        ("{a:1," * 31 + "1," * 29_000 + "^", "unreadable"),
        ("```" + " " * 60_000, "unreadable"),
        ('{"a": 1}' * 64, "unreadable"),
        ("{'a': '" + "' " * 30_000, "truncated"),
        ('{"sub_tasks": [{"name": "Rest"}, ...]}', "unreadable"),
    ],
)
def test_what_is_no_object_is_told_apart(text: str, outcome: str) -> None:
    with pytest.raises(ReplyError) as caught:
        read_object(text)
    assert caught.value.outcome == outcome
    assert len(str(caught.value)) < 400


def test_the_error_says_where_the_grammar_is_wrong() -> None:
    with pytest.raises(ReplyError, match=r"delimiter near .*Rest"):
        read_object('{"sub_tasks": [{"name": "Rest"} {"name": "Go"}]}')


@given(objects(st.text()), st.text(alphabet="ab {}[]`\n"))
def test_every_object_survives_being_wrapped(value: dict, prose: str) -> None:
    text = json.dumps(value)
    assert read_object(text) == value
    assert read_object(f"```json\n{text}\n```") == value or "```" in text
    try:
        read_object(prose + text)
    except ReplyError:
        assert "{" in prose


@given(objects(st.text(alphabet="abé ',:{}[]\"")))
def test_every_object_survives_being_written_as_python_does(value: dict) -> None:
    assert read_object(repr(value)) == value


@given(
    st.text(alphabet="{}[]:,'\"\\/*#ab1-.e \n") | st.from_regex(re.compile(r"(\{\s*['\"a]|[]},:'\"\\\n])*"))
)
def test_no_text_raises_anything_else(text: str) -> None:
    with contextlib.suppress(ReplyError):
        read_object(text)


def test_the_longest_reply_is_read() -> None:
    text = '{"a": "' + "x" * (MAX_CHARACTERS - 9) + '"}'
    assert len(text) == MAX_CHARACTERS
    assert read_object(text)["a"].startswith("xxx")
