"""Models and requests to make small ledgers of."""

from __future__ import annotations

from dataclasses import replace

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ModelBusy, ReplyError
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.ledger.reader import ledger_files
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage

SCHEMA = {"type": "object", "properties": {"id": {"enum": ["sofa", "bed"]}}}
SYSTEM = ChatMessage("system", "You are a robot.")


def asked(text: str = "Where to?", **changes) -> LMRequest:
    request = LMRequest((SYSTEM, ChatMessage("user", text)), "generate", agent="r1", episode="e1", seed=7)
    return replace(request, **changes)


def reply_format(schema=SCHEMA) -> ReplyFormat:
    return ReplyFormat("choice", schema, Reading)


class Counting(LanguageModel):
    """Answers `answer N to TEXT` and remembers what was asked; what an `!` begins is an error."""

    name = "counting-1"
    window = 9000

    def __init__(self) -> None:
        self.asked: list[LMRequest] = []

    def complete(self, request: LMRequest) -> LMResponse:
        self.asked.append(request)
        text = request.messages[-1].content
        answer = f"answer {len(self.asked)} to {text}"
        response = LMResponse(
            answer, self.name, Usage(10, 3, 0.25), "stop", raw={"id": len(self.asked), "text": answer}
        )
        if text.startswith("!busy"):
            raise ModelBusy("the provider has a fault")
        if text.startswith("!empty"):
            raise ReplyError("nothing there", "empty")
        if text.startswith("!cut"):
            raise ReplyError("cut off", "truncated", response)
        return response

    def count_tokens(self, messages) -> int:
        return 77


class Interrupted(Counting):
    """As if somebody pressed Ctrl-C."""

    def complete(self, request: LMRequest) -> LMResponse:
        raise KeyboardInterrupt


def record(folder, *requests: LMRequest) -> list[object]:
    """Ask a fresh model everything in one fresh episode; returns texts and errors."""
    model = LedgerModel(Counting(), folder)
    model.begin_episode("e1", 0)
    return [outcome(model, request) for request in requests]


def outcome(model: LanguageModel, request: LMRequest) -> object:
    try:
        return model.complete(request).text
    except (ReplyError, ModelBusy) as error:
        return repr(error)


def only_file(folder):
    (file,) = ledger_files(folder)
    return file.path


def entries_of(folder) -> list[object]:
    return [entry for file in ledger_files(folder) for _, entry in file.entries()]
