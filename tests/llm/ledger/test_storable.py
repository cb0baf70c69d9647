from __future__ import annotations

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from recorded_calls import Counting, asked, entries_of, only_file

from adhoc.core.errors import ModelError
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.replaying import ReplayModel
from adhoc.llm.ledger.storable import MOST_DEPTH, storable, without_keys
from adhoc.llm.model import LMResponse

KEY = "sk-proj-abcDEF0123456789abcDEF"
OWN = "c0ffee-of-our-own-1234"


@pytest.mark.parametrize(
    "key",
    [
        KEY,
        "sk-abcd*******wxyz",
        "gsk_0123456789abcdefghijklmn",
        "hf_ABCDEFGHIJKLMNOPQRSTUVWX",
        "AIzaSyA0123456789_abcdefghijklmnopqrst",
        "AKIA0123456789ABCDEF",
        "Bearer abcdef.ghijkl-123",
    ],
)
def test_keys_of_known_forms_are_removed(key):
    assert without_keys(f"Incorrect key: {key}, see") == "Incorrect key: [removed], see"
    assert without_keys(key) == "[removed]"


@pytest.mark.parametrize(
    "text", ["desk-on-the-left-side-of-it", "the mask-like-thing-in-room-4", "sk-12", "no"]
)
def test_other_words_stay(text):
    assert without_keys(text) == text


def test_keys_of_this_process_are_removed_and_placeholders_are_not(monkeypatch):
    monkeypatch.setenv("MY_LAB_API_KEY", OWN)
    monkeypatch.setenv("OTHER_API_KEY", "not-needed")
    assert without_keys(f"{OWN} is not-needed") == "[removed] is not-needed"


def test_headers_are_left_out_wherever_they_are():
    raw = {
        "id": "x",
        "headers": {"a": 1},
        "_hidden_params": {"additional_headers": {}},
        "nested": [{"Authorization": "secret", "X-Api-Key": "y", "Set-Cookie": "z", "text": f"key {KEY}"}],
        "response_headers": {},
    }
    assert storable(raw) == {"id": "x", "nested": [{"text": "key [removed]"}]}


def test_what_json_cannot_say_is_a_text():
    deep: list[object] = []
    for _ in range(5000):
        deep = [deep]
    stored = storable(
        {"nan": math.nan, "inf": math.inf, "bytes": b"x", "huge": 10**5000, 3: (1, 2), "deep": deep}
    )
    assert stored["nan"] == "nan"
    assert stored["inf"] == "inf"
    assert stored["bytes"] == "<bytes>"
    assert stored["huge"] == "a number of 16610 bits"
    assert stored["3"] == [1, 2]
    text = json.dumps(stored, allow_nan=False)
    assert text.count("[") <= MOST_DEPTH + 1


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(JSON)
def test_anything_can_be_stored(value):
    stored = storable(value)
    assert json.loads(json.dumps(stored, allow_nan=False)) == stored


class Talkative(Counting):
    """A provider that sends keys back."""

    def complete(self, request):
        super().complete(request)
        if request.messages[-1].content == "fail":
            raise ModelError(f"Incorrect API key provided: {OWN} or {KEY}")
        raw = {"choices": [f"your key is {OWN}"], "headers": {"authorization": f"Bearer {OWN}"}}
        return LMResponse(f"your key is {OWN} or {KEY}", self.name, raw=raw)


def test_no_key_reaches_the_disk_and_live_and_replayed_answers_agree(tmp_path, monkeypatch):
    monkeypatch.setenv("MY_LAB_API_KEY", OWN)
    model = LedgerModel(Talkative(), tmp_path)
    live = model.complete(asked(f"hello, {OWN}"))
    with pytest.raises(ModelError):
        model.complete(asked("fail"))
    stored = only_file(tmp_path).read_text()
    assert OWN not in stored
    assert KEY not in stored
    assert "headers" not in stored
    assert live.text == "your key is [removed] or [removed]"
    assert live.raw == {"choices": ["your key is [removed]"]}
    monkeypatch.delenv("MY_LAB_API_KEY")
    assert ReplayModel(tmp_path).complete(asked(f"hello, {OWN}")).text == live.text
    redacted = [entry for entry in entries_of(tmp_path) if getattr(entry, "redacted", False)]
    assert [text.content for text in redacted] == ["hello, [removed]"]
