"""Runs with caps: how they end, go on, and what they say that they cost."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from paid_model import PaidReasoner

from adhoc.cli.main import main
from adhoc.evaluation.records import RecordFile, checked_part
from adhoc.llm.limiting import CallLimiter

CALLS = 18
"""What the newcomer asks in the one scenario, without caps."""


@pytest.fixture(autouse=True)
def _fresh(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(PaidReasoner, "calls", [])
    monkeypatch.setattr(PaidReasoner, "dies_at", None)


def run(*arguments, out="results"):
    return main(
        [
            "run",
            "policy=irot",
            "llm._target_=paid_model.PaidReasoner",
            "benchmark.draws=[{house: one_room, seed: 1, misplaced: 2, teammates: 3}]",
            "max_steps=60",
            f"out={out}",
            "pictures=false",
            "transcript=false",
            *arguments,
        ]
    )


def records(out="results", name="episodes.jsonl"):
    return [checked_part(record) for record in RecordFile(out, name).read()]


def newcomer(out="results"):
    return records(out)[-1]


def test_a_cap_of_an_episode_ends_it_with_a_record_that_says_so(capsys):
    assert run("budget.episode.calls=7") == 0
    record = newcomer()
    assert (record["ending"], record["reached_cap"]) == ("budget reached", "budget.episode.calls")
    assert (record["success"], record["temporal_steps"], record["efficiency"]) == (False, 60, 0.0)
    assert record["llm"]["calls"] == len(PaidReasoner.calls) == 7
    assert record["steps"] < 60
    assert "budget reached, 0/2 re-placed" in capsys.readouterr().out
    assert run("budget.episode.calls=7") == 0
    assert len(PaidReasoner.calls) == 7


def test_the_team_alone_is_not_asked_anything_and_knows_no_cap():
    run("budget.episode.calls=7")
    run(out="free")
    alone, capped = records()
    free_alone, free = records("free")
    assert alone == free_alone
    assert capped["config_hash"] != free["config_hash"]
    assert (free["ending"], free["llm"]["calls"]) == ("all misplaced objects re-placed", CALLS)


@pytest.mark.parametrize("killed_at", [1, 7])
def test_a_capped_episode_that_was_killed_ends_where_it_would_have_ended(killed_at, monkeypatch):
    run("budget.episode.calls=7", out="whole")
    PaidReasoner.calls.clear()
    monkeypatch.setattr(PaidReasoner, "dies_at", killed_at)
    assert run("budget.episode.calls=7") == 130
    monkeypatch.setattr(PaidReasoner, "dies_at", None)
    assert run("budget.episode.calls=7") == 0
    assert records() == records("whole")
    assert len(PaidReasoner.calls) == 7 + 1


def test_money_and_tokens_of_an_episode_count_what_was_replayed(monkeypatch):
    caps = ["budget.episode.usd=0.2", "budget.episode.tokens=20000", "llm.price={prompt: 10, completion: 30}"]
    run(*caps, out="whole")
    asked = len(PaidReasoner.calls)
    assert 0.1 < newcomer("whole")["llm"]["cost_usd"] <= 0.2
    monkeypatch.setattr(PaidReasoner, "dies_at", asked + 3)
    assert run(*caps) == 130
    assert run(*caps) == 0
    assert records() == records("whole")
    PaidReasoner.calls.clear()
    assert run(*caps, "ledger.mode=replay", "ledger.path=results/ledger", out="replayed") == 0
    assert records("replayed") == records("whole")
    assert PaidReasoner.calls == []


def test_a_run_that_reaches_its_cap_stops_with_one_sentence_and_goes_on_with_a_larger_one(capsys):
    for calls in (5, 5, 11):
        assert run(f"budget.run.calls={calls}") == 3
        error = capsys.readouterr().err
        assert error == (
            f"adhoc run: stopped: budget.run.calls={calls}: reached; {calls} spent, and the next call may "
            "take 1; the same command with a larger cap goes on where it stopped\n"
        )
        assert len(records()) == 1
        (unfinished,) = records(name="unfinished.jsonl")
        assert (unfinished["ending"], unfinished["reached_cap"]) == ("budget reached", "budget.run.calls")
        assert unfinished["llm"]["calls"] == calls
    assert run("budget.run.calls=1000") == 0
    assert not Path("results/unfinished.jsonl").exists()
    assert len(PaidReasoner.calls) == CALLS
    run(out="whole")
    assert records() == records("whole")


def test_a_cap_of_money_holds_over_sessions(capsys):
    price = "llm.price={prompt: 10, completion: 30}"
    spent = []
    for usd in (0.15, 0.3, 0.3):
        assert run(f"budget.run.usd={usd}", price) == 3
        (record,) = records(name="unfinished.jsonl")
        spent.append(record["llm"]["cost_usd"])
    assert spent[0] <= 0.15 < spent[1] <= 0.3
    assert spent[1] == spent[2]


def test_without_a_price_money_cannot_be_capped(capsys):
    assert run("budget.run.usd=5", "llm.price=null", "+llm.model=unheard-of") == 2
    error = capsys.readouterr().err
    assert "budget.run.usd=5.0: the price of unheard-of is not known; give 'llm.price={" in error
    assert error.count("\n") == 1
    assert PaidReasoner.calls == []


@pytest.mark.parametrize(
    ("argument", "told"),
    [
        ("budget.run.usd=-1", "budget.run.usd=-1.0: must be at least 0, or null for no cap"),
        ("budget.run.usd=abc", "'abc' of type 'str' could not be converted to Float"),
        ("budget.episode.calls=1.5", "could not be converted to Integer"),
        ("budget.episode.usd=nan", "budget.episode.usd=nan: must be at least 0"),
        ("budget.run.euro=3", "there is no such key (keys of budget.run: calls, tokens, usd)"),
        ("budget.day.usd=3", "there is no such key (keys of budget: episode, run)"),
        ("budget=5", "budget"),
        ("llm.price=5", "llm.price=5: must be {prompt: P, completion: C}"),
        ("llm.price={prompt: 5, reply: 5}", "llm.price"),
        ("llm.price={prompt: -5, completion: 1}", "llm.price.prompt=-5: must be a number of US dollars"),
        ("ledger.mode=rekord", "ledger.mode=rekord: must be one of auto, record, replay, off"),
        ("ledger.mode=replay", "results/ledger"),
        ("ledger.path=", "ledger.path=: must name a folder"),
        ("ledger.path=results", "ledger.path=results: is the run folder (out)"),
        ("retry.attempts=0", "retry: RetryingModel: attempts is 0, it must be at least 1"),
        ("retry.wait=nan", "retry: RetryingModel: wait=nan"),
        ("rate.concurrent=0", "rate: CallLimiter: concurrent=0"),
        ("rate.per_minute=0", "per_minute=0 must be at least 1"),
        ("retry.tries=3", "keys of retry: attempts, wait, max_wait, total_wait"),
    ],
)
def test_a_wrong_value_is_one_line_and_nothing_is_paid(capsys, argument, told):
    assert run(argument) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert told in error
    assert PaidReasoner.calls == []


def test_the_cost_of_every_stage_is_told_after_a_run_and_in_the_report(capsys):
    run()
    told = capsys.readouterr().out
    main(["report", "results", "--markdown", "table.md"])
    assert "Calls of language models" in told
    report = capsys.readouterr().out
    for text in (told, report):
        stages = [line.split()[:2] for line in text.splitlines() if line.split()[:1] == ["sub_skill"]]
        assert stages == [["sub_skill", "10"]]
    assert "| IRoT-LLM (paid) | all | 18 |" in Path("table.md").read_text()


def test_the_offline_reasoner_has_no_costs(capsys):
    assert run("llm._target_=adhoc.llm.offline.reasoner.OfflineReasoner") == 0
    main(["report", "results"])
    assert "Calls of language models" not in capsys.readouterr().out
    assert not Path("results/ledger").exists()


class TestDryRun:
    def test_asks_no_model_and_leaves_nothing(self, capsys):
        assert run("dry_run=true", "llm.price={prompt: 10, completion: 30}") == 0
        assert PaidReasoner.calls == []
        assert list(Path().iterdir()) == []
        told = capsys.readouterr().out
        assert "Counted with the offline reasoner (not a language model) in 1 of 1 scenarios." in told
        (whole,) = (line for line in told.splitlines() if line.startswith("The whole run"))
        run("llm.price={prompt: 10, completion: 30}")
        real = newcomer()["llm"]
        assert whole.startswith(
            f"The whole run: 2 episodes, {real['calls']} calls, {real['prompt_tokens']:,} tokens in, "
            f"{real['completion_tokens']:,} out, ${real['cost_usd']:.4f}."
        )

    def test_a_sweep_leaves_nothing_either(self, capsys):
        assert run("-m", "dry_run=true", "policy=irot,none", "llm=gpt4_paper") == 0
        assert list(Path().iterdir()) == []
        told = capsys.readouterr().out
        assert "gpt-4-1106-preview at $10 for a million prompt tokens and $30" in told
        (total,) = (line for line in told.splitlines() if line.startswith("The whole sweep: "))
        assert total.startswith(f"The whole sweep: 2 episodes, {CALLS} calls, ")
        run("-m", "dry_run=true", "policy=random,none", "llm=gpt4_paper")
        assert "Dry run: Random, No ad hoc: no language model is asked." in capsys.readouterr().out

    def test_a_sweep_counts_its_team_alone_once(self, capsys):
        """Two joining steps of one policy with a team that asks: what the run itself then asks."""
        sweep = ("-m", "policy=irot", "team=llm", "join_step=0,5", "llm.price={prompt: 10, completion: 30}")
        assert run(*sweep, "dry_run=true") == 0
        told = capsys.readouterr().out
        run(*sweep)
        real = records()
        calls = {record["join_step"]: record["llm"]["calls"] for record in real}
        cost = sum(record["llm"]["cost_usd"] for record in real)
        assert calls[None] > 0
        (total,) = (line for line in told.splitlines() if line.startswith("The whole sweep: "))
        assert total.startswith(f"The whole sweep: 3 episodes, {sum(calls.values()):,} calls, ")
        assert f"${cost:,.4f}." in total or f"${cost:,.2f}." in total
        rows = [
            line.split() for line in told.splitlines() if line.strip().startswith(("LLM based alone", "IRoT"))
        ]
        assert [row[-6:-3] for row in rows] == [
            [{None: "-"}.get(step, str(step)), "1", str(calls[step])] for step in (None, 0, 5)
        ], "one short row for each"

    def test_several_runs_have_a_total(self, capsys):
        assert run("-m", "dry_run=true", "retry.attempts=3,4") == 0
        told = capsys.readouterr().out
        assert told.count("The whole run: 2 episodes") == 2
        assert f"All 2 runs: 4 episodes, {2 * CALLS} calls" in told

    def test_caps_are_compared_with_the_estimate(self, capsys):
        run("dry_run=true", "budget.run.calls=9", "budget.run.tokens=10000000")
        told = capsys.readouterr().out
        assert "budget.run.calls=9 would stop the run after about 50% of it." in told
        assert "budget.run.tokens" not in told

    def test_a_value_that_the_run_refuses_is_refused(self, capsys):
        assert run("dry_run=true", "budget.run.usd=-1") == 2
        assert run("dry_run=true", "llm.price=3") == 2
        assert "llm.price=3: must be" in capsys.readouterr().err

    @pytest.mark.parametrize("argument", ["ledger.mode=rekord", "rate.per_minute=0", "retry.attempts=0"])
    def test_values_that_only_a_real_model_needs_are_checked_too(self, capsys, argument):
        assert run("dry_run=true", argument) == 2
        assert argument.split("=")[0].split(".")[0] in capsys.readouterr().err

    def test_a_model_that_is_not_named_is_missed_only_where_one_is_asked(self, capsys):
        assert main(["run", "dry_run=true", "llm=litellm"]) == 2
        assert capsys.readouterr().err.endswith("error: llm.model=...: must be given\n")
        assert main(["run", "dry_run=true", "llm=litellm", "policy=none"]) == 0

    def test_a_rate_does_not_slow_it_down(self, monkeypatch):
        """18 calls at 1 a minute."""
        reserve = CallLimiter._reserve

        def at_once(limiter):
            assert reserve(limiter) == 0.0
            return 0.0

        monkeypatch.setattr(CallLimiter, "_reserve", at_once)
        assert run("dry_run=true", "rate.per_minute=1") == 0

    def test_litellm_is_not_needed_for_the_papers_prices(self, capsys):
        import subprocess
        import sys

        arguments = ["run", "dry_run=true", "llm=gpt4_paper", "limit=1", "max_steps=3"]
        program = (
            "import sys\nfrom adhoc.cli.main import main\n"
            f"code = main({json.dumps(arguments)})\n"
            "sys.exit('litellm' if 'litellm' in sys.modules else code)"
        )
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
