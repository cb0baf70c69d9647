"""Every dialect that is understood keeps the contract, and so does an adapter that somebody writes."""

from __future__ import annotations

import json

from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.dialect import Adapter
from adhoc.agents.dialects.sentences import Sentences
from adhoc.agents.dialects.structured import Structured
from adhoc.core.messages import Message, MessageKind
from adhoc.testing.dialect_contract import AdapterContract, DialectContract


class TestStructured(DialectContract):
    make = Structured


class TestCodes(DialectContract):
    make = Codes


class TestSentences(DialectContract):
    make = Sentences


class Json(Adapter):
    """A team that sends JSON in its text, with words of its own."""

    name = "json"

    def read(self, message):
        try:
            said = json.loads(message.text)
        except (ValueError, RecursionError):
            return None
        if not isinstance(said, dict):
            return None
        return {"position": said.get("at"), "stopped": said.get("done"), "room": said.get("zone", 0)}


class TestJson(AdapterContract):
    make = Json
    samples = (
        (
            Message(MessageKind.TASK_STATE, '{"at": [1, 2.5], "done": true}'),
            {"position": [1, 2.5], "stopped": True},
        ),
        (Message(MessageKind.TASK_STATE, '{"zone": "room|1"}'), {"room": "room|1"}),
    )
