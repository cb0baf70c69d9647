"""A whole run through an outage of its provider: it completes, and pays for no answer twice."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from whole_runs import finish, records_of, start

from adhoc.cli.main import main
from adhoc.testing.loopback_provider import LoopbackProvider
from adhoc.testing.provider_faults import ANSWER

pytestmark = pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::UserWarning"
)
ATTEMPTS = 8
OUTAGE = (
    "ok,429:0.01,429*2,ok,500,503*3,ok,drop*2,html,html502*2,ok,truncated,foreign,silence:{silence},ok,"
    "429:0.02,503,drop,500,html,429,truncated,ok"
)
"""What happens in a bad night; the longest row of failures is one shorter than a call has attempts."""
IMPATIENT = ("llm.timeout=3", "retry.wait=0.01")


def overrides(provider: LoopbackProvider, *more: str) -> tuple[str, ...]:
    """Two short episodes in the smallest of the shipped houses."""
    return (
        "policy=irot",
        "join_step=3",
        "max_steps=40",
        "limit=1",
        "pictures=false",
        "transcript=false",
        "llm=litellm",
        "llm.model=openai/small",
        f"llm.api_base={provider.url}",
        f"retry.attempts={ATTEMPTS}",
        *more,
    )


def small_run(provider: LoopbackProvider, folder: Path, *more: str) -> int:
    """In this process; the exit code."""
    return main(["run", *overrides(provider, *IMPATIENT, *more), f"out={folder}"])


def failures_of(provider: LoopbackProvider, first: int) -> Counter[str]:
    """How often each content was asked without an answer, from the call of this number on."""
    return Counter(call.content for call in provider.calls[first:] if call.fault != ANSWER)


def test_a_run_goes_through_an_outage_and_ends_as_if_there_had_been_none(tmp_path: Path) -> None:
    with LoopbackProvider() as provider:
        assert small_run(provider, tmp_path / "undisturbed") == 0
        calls, answered = len(provider.calls), provider.answered
        provider.fail_next(OUTAGE.format(silence=4))
        assert small_run(provider, tmp_path / "outage") == 0
        failures = failures_of(provider, calls)
        assert provider.answered == answered + answered, "every answer is paid once"
    assert failures.total() == 22, "the whole script was played"
    assert max(failures.values()) == ATTEMPTS - 1
    assert len(records_of(tmp_path / "outage")) == 2
    assert records_of(tmp_path / "outage") == records_of(tmp_path / "undisturbed")


def test_an_outage_that_does_not_end_stops_the_run_which_goes_on_later(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with LoopbackProvider() as provider:
        provider.fail_next("ok*3,503*100")
        assert small_run(provider, tmp_path / "run") != 0
        assert f"asked {ATTEMPTS} times" in capsys.readouterr().err
        assert len(provider.calls) == 3 + ATTEMPTS
        provider.fail_next("ok")
        assert small_run(provider, tmp_path / "run") == 0
        assert set(provider.answered.values()) == {1}
    assert len(records_of(tmp_path / "run")) == 2


def test_an_outage_costs_no_more_than_the_cap(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with LoopbackProvider() as provider:
        provider.fail_next("ok,429:0.01,ok,500,drop,ok,truncated,html502")
        assert small_run(provider, tmp_path, "budget.run.calls=5") != 0
        assert "budget.run.calls" in capsys.readouterr().err
        assert provider.answered.total() <= 5


@pytest.mark.stress
@pytest.mark.timeout(900)
def test_thirty_seconds_of_silence_and_two_workers(tmp_path: Path) -> None:
    """With the waits as they are by default, but for the first, and real seconds of Retry-After."""
    more = ("workers=2", "retry.wait=0.5", "limit=2")
    script = OUTAGE.format(silence=30).replace("429:0.0", "429:")
    with LoopbackProvider() as provider:
        undisturbed, outage = tmp_path / "undisturbed", tmp_path / "outage"
        finish(start(undisturbed, provider.url, overrides(provider, *more)), undisturbed)
        calls, answered = len(provider.calls), provider.answered
        provider.fail_next(script)
        finish(start(outage, provider.url, overrides(provider, *more)), outage)
        assert provider.answered == answered + answered
        assert max(failures_of(provider, calls).values()) < ATTEMPTS
    assert len(records_of(outage)) == 4
    assert records_of(outage) == records_of(undisturbed)


@pytest.mark.stress
@pytest.mark.parametrize("cap", [1, 4, 9])
def test_two_workers_spend_no_more_than_the_cap_and_one_call_each(tmp_path: Path, cap: int) -> None:
    more = ("workers=2", "retry.wait=0.01", "limit=2", f"budget.run.calls={cap}")
    with LoopbackProvider(faults="429:0.01,ok,500,drop,ok,truncated,html502") as provider:
        process = start(tmp_path / "run", provider.url, overrides(provider, *more))
        assert process.wait(240) != 0
        assert cap <= provider.answered.total() <= cap + 2
    assert "budget.run.calls" in (tmp_path / "run.output").read_text()
