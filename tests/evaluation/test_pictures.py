from __future__ import annotations

from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario, two_rooms
from markdown_it import MarkdownIt

from adhoc.agents.policy import Turn
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ReplyError
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.exchanges import TranscribingModel
from adhoc.evaluation.floor_drawing import draw_floor_plan
from adhoc.evaluation.floor_shapes import footprint
from adhoc.evaluation.picture import draw_episode
from adhoc.evaluation.recording import make_record
from adhoc.evaluation.transcript import write_transcript
from adhoc.llm.model import LMRequest
from adhoc.llm.scripted import ScriptedModel

DECISION = {
    "reason": "joined the team",
    "chosen": "Explore kitchen",
    "fallback": None,
    "candidates": [{"sub_task": "Explore kitchen", "rationale": "unseen", "score": 0.75}],
    "ranking": [{"sub_task": "Explore kitchen", "rationale": "", "score": None}],
    "replies": [{"sender": "teammate_1", "text": "go ahead"}],
    "verdicts": [{"sub_task": "Explore kitchen", "feasible": True, "reason": "nobody is there"}],
    "exchanges": [
        {"stage": "generate", "prompt": [{"role": "user", "content": "a ``` fence"}], "reply": "{}"}
    ],
}


class Thinker(Script):
    """Reports decisions at some steps."""

    def __init__(self, traces, *actions):
        super().__init__(*actions)
        self.traces = traces

    def act(self, observation, inbox):
        turn = super().act(observation, inbox)
        return Turn(turn.action, turn.outbox, self.traces.get(observation.step, {}))


def play(newcomer, max_steps=20, join_step=3):
    where = scenario()
    result = run_episode(GridWorld(), where, Errand(), [Script(), Script()], newcomer, join_step, max_steps)
    conditions = Conditions(Errand(), Contender("walkers", "Walkers", lambda seat: Script()), max_steps)
    key = EpisodeKey(
        where,
        EpisodeKind(conditions, Contender("thinker", "Thinker", lambda seat: Script()), join_step),
    )
    return result, make_record(key, result, None, {}, 0.0)


class TestPicture:
    def test_paths_objects_and_the_joining_point_are_drawn(self, tmp_path):
        result, record = play(Script(*fetch("apple", "counter")))
        path = tmp_path / "pictures" / "episode.png"
        draw_episode(result, record, path)
        pixels = matplotlib.image.imread(path)[..., :3]
        assert pixels.shape[1] == 990
        for colour in ("#e69f00", "#0072b2", "#c1272d", "#006e53", "#fbe8d3", "#dde7f5"):
            wanted = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
            assert (np.abs(pixels - wanted).max(axis=-1) < 0.02).sum() > 20, colour

    def test_equal_episodes_give_equal_files(self, tmp_path):
        for name in ("a.png", "b.png"):
            draw_episode(*play(Script()), tmp_path / name)
        assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()

    def test_an_episode_that_ends_before_the_newcomer_joins(self, tmp_path):
        draw_episode(*play(None), tmp_path / "alone.png")
        assert (tmp_path / "alone.png").stat().st_size > 5000

    def test_a_floor_plan(self, tmp_path):
        draw_floor_plan(two_rooms(), tmp_path / "plan.png")
        assert (tmp_path / "plan.png").stat().st_size > 3000

    def test_footprints_turn_with_the_object(self):
        from dataclasses import replace

        bed = replace(two_rooms().object("bed"), yaw=np.pi / 2)
        xs, ys = zip(*footprint(bed))
        assert (max(xs) - min(xs), max(ys) - min(ys)) == pytest.approx((0.5, 1.0))


class TestTranscript:
    def test_every_part_of_a_decision_is_told(self):
        result, record = play(Thinker({4: {"decision": DECISION, "skills": [{"chosen": "GoTo door"}]}}))
        page = write_transcript(result, record)
        assert page is not None
        for part in (
            "# A decision of newcomer at step 4",
            "why it planned: joined the team",
            "chosen sub-task: Explore kitchen",
            "sub-skill: GoTo door",
            "`Explore kitchen` (score 0.75): unseen",
            "1. `Explore kitchen`",
            "**teammate_1**: go ahead",
            "`Explore kitchen`: feasible, nobody is there",
            "## Sub-task planner: generate",
            "````text\na ``` fence\n````",
        ):
            assert part in page, part

    def test_what_robots_and_models_say_brings_no_markup(self):
        hostile = "![x](http://a.b/c) [y](z) **b** `c` <img src=x> \n## Heading\n~~s~~ _e_ room_5 \x1b[31m"
        decision = {
            "reason": hostile,
            "chosen": hostile,
            "fallback": hostile,
            "candidates": [{"sub_task": hostile, "rationale": hostile}],
            "replies": [{"sender": hostile, "text": hostile}],
            "verdicts": [{"sub_task": hostile, "feasible": False, "reason": hostile}],
            "exchanges": [
                {"stage": hostile, "prompt": [{"role": hostile, "content": "x"}], "reply": hostile}
            ],
        }
        skills = [{"chosen": hostile}, {"refused": hostile}]
        page = str(write_transcript(*play(Thinker({4: {"decision": decision, "skills": skills}}))))
        html = MarkdownIt("commonmark").enable("strikethrough").render(page)
        assert "\x1b" not in page
        for tag in ("<img", "<a ", "<em>", "<s>", "<strong>b</strong>", "<h2>Heading"):
            assert tag not in html, tag
        assert "room_5" in page.split("```text")[0], "names stay as they are"

    def test_the_decision_with_most_replies_is_chosen(self):
        poor = {**DECISION, "replies": [], "chosen": "Stop"}
        result, record = play(
            Thinker({4: {"decision": poor}, 6: {"decision": DECISION}, 8: {"decision": poor}})
        )
        assert "at step 6" in str(write_transcript(result, record))

    @pytest.mark.parametrize(
        "trace",
        [{}, {"other": 1}, {"decision": "text"}, {"decision": {}}],
    )
    def test_nothing_to_tell(self, trace):
        assert write_transcript(*play(Thinker({4: trace}))) is None

    @pytest.mark.parametrize("odd", [None, "text", [1, None], {"a": 1}, [{"x": 1}]])
    def test_odd_traces_are_borne(self, odd):
        trace = {"decision": dict.fromkeys(("candidates", "replies", "verdicts", "exchanges"), odd)}
        trace["decision"]["chosen"] = "Stop"
        page = write_transcript(*play(Thinker({4: trace})))
        assert page is not None
        assert "chosen sub-task: Stop" in page

    def test_fallbacks_and_refusals_are_counted_in_the_record(self):
        traces = {
            4: {"decision": {**DECISION, "fallback": "all refused"}},
            5: {"skills": [{"refused": "no reply"}]},
            6: {"decision": DECISION},
        }
        _, record = play(Thinker(traces))
        assert record["planning"] == {"sub_tasks": 2, "fallbacks": 1, "refused_skills": 1}


def test_exchanges_are_taken_once_and_bounded():
    replies = ["one", ReplyError("nothing")] + ["x"] * 102
    model = TranscribingModel(ScriptedModel(replies, name="tiny"))
    request = LMRequest((ChatMessage("user", "question"),), "generate")
    assert model.name == "tiny"
    assert model.complete(request).text == "one"
    with pytest.raises(ReplyError):
        model.complete(request)
    first, second = model.take("")
    assert first == {
        "stage": "generate",
        "prompt": [{"role": "user", "content": "question"}],
        "reply": "one",
        "model": "tiny",
        "prompt_tokens": 1,
        "completion_tokens": 1,
        "cost_usd": 0.0,
    }
    assert "nothing" in second["reply"]
    assert model.take("") == []
    for _ in range(100):
        model.complete(request)
    assert len(model.take("")) == 64
    model.complete(replace(request, agent="a"))
    model.complete(replace(request, agent="b"))
    assert len(model.take("a")) == len(model.take("b")) == 1
