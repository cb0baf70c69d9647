"""Episodes on a grid that were looked at, with whatever robots and models are made to say."""

from __future__ import annotations

from typing import Any

from grid_world import Errand, GridWorld, Script, fetch, scenario

from adhoc.agents.policy import Turn
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.keyed_episode import run_keyed
from adhoc.evaluation.observer import BLIND
from adhoc.evaluation.recording import make_record
from adhoc.inspecting.recorder import Recorder
from adhoc.inspecting.watching import Watched

HOSTILE = (
    "</script><script>document.title='taken'</script><img src=x onerror=\"document.title='taken'\">"
    "<!-- ]]> ${alert(1)} `'\"\\ \u2028\u2029 \x00\x1b[31m \u202etxt.exe \ud800 @DATA@ @SCRIPT@ &lt;b&gt; "
    "javascript:alert(1)"
)


def decision(text: str = "go", chosen: str = "Explore kitchen") -> dict[str, Any]:
    return {
        "reason": text,
        "chosen": chosen,
        "fallback": text,
        "degraded": [text],
        "rounds": 1,
        "candidates": [{"sub_task": chosen, "rationale": text, "score": 0.75}, {"sub_task": text}],
        "ranking": [{"sub_task": chosen, "rationale": text, "score": None}],
        "predictions": [{"teammate": "teammate_1", "sub_task": text, "sub_skill": text}],
        "replies": [{"sender": "teammate_1", "text": text}],
        "verdicts": [{"sub_task": chosen, "feasible": False, "reason": text}],
        "objections": [{"objector": "teammate_2", "planner": text, "sub_task": text, "reason": text}],
        "exchanges": [
            {
                "stage": text,
                "prompt": [{"role": "system", "content": f"a\nb\n{text}"}, {"role": text, "content": "a\nb"}],
                "reply": text,
                "model": "tiny",
                "prompt_tokens": 12,
                "completion_tokens": 3,
                "cost_usd": 0.25,
            }
        ],
    }


class Talker(Script):
    """Follows a script, says something at every step, and reports decisions at some."""

    def __init__(self, *actions, traces=None, say="hello"):
        super().__init__(*actions, say=say)
        self.traces = traces or {}

    def act(self, observation, inbox):
        turn = super().act(observation, inbox)
        doing = {"sub_task": f"at {observation.step // 4}", "sub_skill": None}
        return Turn(turn.action, turn.outbox, {"doing": doing, **self.traces.get(observation.step, {})})


def key_of(join_step: int | None = 3, text: str = "go", max_steps: int = 12) -> EpisodeKey:
    traces = {
        3: {"decision": decision(text)},
        5: {"skills": [{"chosen": text, "fallback": None, "exchanges": []}, {"refused": text}]},
        6: {"superseded": [decision(text)], "decision": decision(text, "Stop"), text: {text: [text]}},
    }
    conditions = Conditions(
        Errand(), Contender("walkers", "Walkers", lambda seat: Talker(say=text)), max_steps
    )
    newcomer = Contender(
        "thinker", "Thinker", lambda seat: Talker(*fetch("apple", "counter"), traces=traces, say=text)
    )
    if join_step is None:
        return EpisodeKey(scenario(), EpisodeKind(conditions))
    return EpisodeKey(scenario(), EpisodeKind(conditions, newcomer, join_step))


def record_of(key: EpisodeKey, alone=None) -> dict[str, Any]:
    return make_record(key, run_keyed(GridWorld(), key, alone, BLIND), alone, {}, 0.0)


def watched(join_step: int | None = 3, text: str = "go", pictures: bool = True) -> Watched:
    key = key_of(join_step, text)
    recorder = Recorder(key.scenario.house, pictures)
    result = run_keyed(GridWorld(), key, None, recorder)
    return Watched(make_record(key, result, None, {}, 0.0), result, recorder.recording)
