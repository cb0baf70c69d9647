"""The provider on loopback that other tests rely upon."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from http.client import IncompleteRead, RemoteDisconnected
from pathlib import Path
from typing import Any

import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.testing.loopback_provider import LoopbackProvider, content_hash, read_counts
from adhoc.testing.provider_faults import parse_script


def ask(url: str, text: str = "hello", **more: Any) -> tuple[Any, bytes]:
    body = {"model": "small", "messages": [{"role": "user", "content": text}], **more}
    request = urllib.request.Request(f"{url}/chat/completions", json.dumps(body).encode())
    with urllib.request.urlopen(request, timeout=5) as response:
        return response.headers, response.read()


def test_answers_count_and_carry_tokens(tmp_path: Path) -> None:
    with LoopbackProvider("a fixed text", count_file=tmp_path / "counts") as provider:
        for text in ("one", "two", "one"):
            completion = json.loads(ask(provider.url, text)[1])
        assert completion["choices"][0]["message"]["content"] == "a fixed text"
        assert completion["usage"]["prompt_tokens"] > 0
        assert sorted(provider.answered.values()) == [1, 2]
        assert read_counts(tmp_path / "counts") == provider.answered


def test_the_offline_reasoner_answers_by_default() -> None:
    with LoopbackProvider() as provider:
        assert json.loads(ask(provider.url)[1])["choices"][0]["message"]["content"] == "{}"


def test_equal_bodies_have_equal_hashes_whatever_the_order() -> None:
    assert content_hash({"a": 1, "b": 2}) == content_hash({"b": 2, "a": 1}) != content_hash({"a": 1})


@pytest.mark.parametrize(("fault", "status"), [("429", 429), ("500", 500), ("html502", 502), ("401", 401)])
def test_refusals_have_their_status(fault: str, status: int) -> None:
    with LoopbackProvider("x", faults=fault) as provider:
        with pytest.raises(urllib.error.HTTPError) as caught:
            ask(provider.url)
        assert caught.value.code == status
        caught.value.close()
        assert ask(provider.url)[1]
        assert [call.fault for call in provider.calls] == [fault, "ok"]
        assert sum(provider.answered.values()) == 1


def test_retry_after_is_a_header_where_it_is_given() -> None:
    with LoopbackProvider("x", faults="429:7, 429") as provider:
        for expected in ("7", None):
            with pytest.raises(urllib.error.HTTPError) as caught:
                ask(provider.url)
            assert caught.value.headers.get("Retry-After") == expected
            caught.value.close()


@pytest.mark.parametrize(
    ("fault", "error"),
    [("drop", RemoteDisconnected), ("silence:0.05", RemoteDisconnected), ("truncated", IncompleteRead)],
)
def test_broken_connections(fault: str, error: type[Exception]) -> None:
    with LoopbackProvider("x", faults=fault) as provider, pytest.raises(error):
        ask(provider.url)


@pytest.mark.parametrize(
    ("fault", "wanted"),
    [
        ("html", b"<html>"),
        ("no_choices", b'"choices": []'),
        ("null", b'"content": null'),
        ("length", b'"finish_reason": "length"'),
        ("foreign", b"greeting"),
    ],
)
def test_useless_answers(fault: str, wanted: bytes) -> None:
    with LoopbackProvider("x", faults=[fault]) as provider:
        assert wanted in ask(provider.url)[1]


def test_wrong_content_type() -> None:
    with LoopbackProvider("x", faults="wrong_type") as provider:
        assert ask(provider.url)[0].get_content_type() == "text/plain"


def test_a_script_may_repeat_and_be_replaced() -> None:
    assert parse_script("503*2, ok,429:1*2") == ["503", "503", "ok", "429:1", "429:1"]
    with LoopbackProvider("x", faults="drop*5") as provider:
        provider.fail_next("foreign")
        assert b"greeting" in ask(provider.url)[1]
        assert b"choices" in ask(provider.url)[1]


@pytest.mark.parametrize("script", ["418", "drop:3", "503*x", "silence", "429:x"])
def test_unknown_faults_are_refused(script: str) -> None:
    with pytest.raises(ConfigurationError, match="fault"):
        parse_script(script)


def test_formats_keys_and_capacity_are_refused() -> None:
    with LoopbackProvider("x", key="good", refuses=["json_schema"]) as provider:
        with pytest.raises(urllib.error.HTTPError) as caught:
            ask(provider.url)
        assert caught.value.code == 401
        caught.value.close()
    with LoopbackProvider("x", refuses=["json_schema"], capacity=0) as provider:
        with pytest.raises(urllib.error.HTTPError) as caught:
            ask(provider.url, response_format={"type": "json_schema"})
        assert caught.value.code == 400
        caught.value.close()
        with pytest.raises(urllib.error.HTTPError) as caught:
            ask(provider.url)
        assert caught.value.code == 429
        caught.value.close()


def test_closing_does_not_wait_for_the_silent() -> None:
    arrived = threading.Event()

    def note_arrival(_: int) -> float:
        arrived.set()
        return 0.0

    with LoopbackProvider("x", faults="silence:60", delay=note_arrival) as provider:
        errors: list[BaseException] = []

        def patient() -> None:
            try:
                ask(provider.url)
            except (RemoteDisconnected, ConnectionResetError) as error:
                errors.append(error)

        client = threading.Thread(target=patient)
        client.start()
        assert arrived.wait(5)
    client.join(5)
    assert errors


def test_runs_as_a_process_and_counts_survive_its_end(tmp_path: Path) -> None:
    counts = tmp_path / "counts"
    command = [sys.executable, "-m", "adhoc.testing.loopback_provider", "--text", "x", "--count-file", counts]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        ask(url)
        process.send_signal(signal.SIGKILL)
    assert sum(read_counts(counts).values()) == 1
