from __future__ import annotations

import base64
import hashlib
import json
import re
import zlib
from dataclasses import replace
from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st
from watched_grid import HOSTILE, watched

from adhoc.core.errors import ConfigurationError, RecordError
from adhoc.inspecting.house_data import house_data, target_data
from adhoc.inspecting.key_steps import key_steps
from adhoc.inspecting.page import page_data, page_text, write_page
from adhoc.inspecting.texts import LONGEST, TextStore


@pytest.fixture(scope="module")
def pair():
    return [watched(None, HOSTILE), watched(3, HOSTILE)]


@pytest.fixture(scope="module")
def text(pair):
    return page_text(page_data(pair), HOSTILE.encode("utf-8", "replace").decode())


def embedded(text):
    (packed,) = re.findall(r'<script id="data" type="text/plain">([^<]*)</script>', text)
    return json.loads(zlib.decompress(base64.b64decode(packed)))


def block(data, number):
    stretches = data["blocks"][number]
    pairs = zip(stretches[::2], stretches[1::2])
    return "\n".join(line for first, count in pairs for line in data["lines"][first : first + count])


def sums(changes):
    total, values = 0, []
    for change in changes:
        total += change
        values.append(total)
    return values


class Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags, self.attributes = [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs


class TestThePageIsSelfContained:
    def test_no_foreign_text_becomes_markup(self, pair, text):
        plain = page_text(page_data([watched(None), watched(3)]), "title")
        hostile, tame = Tags(), Tags()
        hostile.feed(text)
        tame.feed(plain)
        assert hostile.tags == tame.tags
        assert hostile.tags.count("script") == 2
        assert "<img src=x" not in text
        assert "document.title='taken'" not in text.replace("&#x27;", "'").split("</title>")[1]

    def test_nothing_is_loaded_from_anywhere(self, text):
        assert not re.search(r"(?i)\b(?:https?|ftp|file|wss?)://|@import|url\(", text)
        found = Tags()
        found.feed(text)
        assert not {name for name, _ in found.attributes} & {"src", "href", "onerror", "onclick", "onload"}
        assert not {"link", "iframe", "img", "object", "base"} & set(found.tags)
        (policy,) = [value for name, value in found.attributes if name == "content" and "-src" in value]
        assert policy.startswith("default-src 'none'; img-src data:;")

    def test_the_policy_names_the_script_that_is_there(self, text):
        script = text[text.rindex("<script>") + len("<script>") : text.rindex("</script>")]
        digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        assert f"script-src 'sha256-{digest}'" in text

    def test_scripts_never_write_markup(self, text):
        script = text[text.rindex("<script>") :]
        for way in ("innerHTML", "outerHTML", "insertAdjacent", "document.write", "eval(", "new Function"):
            assert way not in script, way


class TestTheData:
    def test_foreign_text_arrives_as_it_was(self, text):
        data = embedded(text)
        said = {data["lines"][message[4]] for message in data["episodes"][1]["messages"]}
        (cleaned,) = said
        assert cleaned.startswith("‹/script›‹script›document.title"), "the channel cleans what robots say"
        trace = data["episodes"][1]["decisions"][0][3]
        assert trace["decision"]["reason"] == HOSTILE
        (exchange,) = trace["decision"]["exchanges"]
        assert block(data, exchange["prompt"][0][1]) == f"a\nb\n{HOSTILE}"
        assert block(data, exchange["reply"]) == HOSTILE
        assert [exchange[name] for name in ("prompt_tokens", "completion_tokens", "cost_usd")] == [
            12,
            3,
            0.25,
        ]

    def test_poses_objects_and_events_are_those_of_the_episode(self, pair):
        data = page_data(pair)
        episode = data["episodes"][1]
        newcomer = episode["robots"][episode["newcomer"]]
        poses = pair[1].recording.tracks["newcomer"].poses
        assert newcomer["first"] == 3
        assert sums(newcomer["x"]) == [round(100 * pose.x) for pose in poses]
        assert sums(newcomer["yaw"]) == [0] * len(poses)
        apple = [it["id"] for it in episode["objects"]].index("apple")
        assert [move[:2] + move[4:5] for move in episode["moves"]] == [
            [4, apple, episode["newcomer"]],
            [5, apple, -1],
        ]
        assert data["lines"][episode["moves"][1][5]] == "counter"
        assert [3, episode["newcomer"], "joined", -1] in episode["events"]

    def test_the_model_is_named(self, pair):
        assert page_data(pair)["episodes"][1]["record"]["model"] is None
        pair[1].record["model"] = "some model"
        assert page_data(pair)["episodes"][1]["record"]["model"] == "some model"
        pair[1].record["model"] = None

    def test_the_common_past_ends_where_the_newcomer_joins(self, pair):
        steps = pair[0].result.steps
        assert page_data(pair)["commonPast"] == [[steps, 3], [3, pair[1].result.steps]]

    def test_misplaced_objects_with_where_they_belong(self, pair):
        apple, knife = target_data(pair[0].result.scenario)
        assert (apple["object"], apple["places"]) == ("apple", ["counter"])
        assert knife["places"] == ["counter"]

    def test_rooms_walls_and_furniture(self, pair):
        house = house_data(pair[0].result.scenario.house)
        assert [room["name"] for room in house["rooms"]] == ["Kitchen", "Bedroom"]
        assert [thing["id"] for thing in house["furniture"]] == ["counter", "bed"]
        assert house["openings"][0]["passable"] is True

    def test_what_did_not_fit_is_counted(self, pair):
        pair[1].recording.left_out = 4
        assert page_data(pair)["episodes"][1]["leftOut"]["decisions"] == 4


class TestWriting:
    def test_the_folder_is_made_and_the_size_told(self, pair, tmp_path):
        path = tmp_path / "deep" / "page.html"
        assert write_page(pair, path) == path.stat().st_size

    def test_what_cannot_be_written_is_one_line(self, pair, tmp_path):
        (tmp_path / "file").write_text("")
        with pytest.raises(RecordError, match=r"file.page\.html: cannot be written"):
            write_page(pair, tmp_path / "file" / "page.html")

    def test_episodes_of_different_tasks_are_refused(self, pair):
        elsewhere = replace(pair[0].result.scenario, id="x")
        other = replace(pair[0], result=replace(pair[0].result, scenario=elsewhere))
        with pytest.raises(ConfigurationError, match="only episodes of one task"):
            page_data([pair[1], other])
        with pytest.raises(ConfigurationError, match="needs an episode"):
            page_data([])


class TestTexts:
    @given(st.lists(st.text(alphabet="ab\n", max_size=12), max_size=8))
    def test_prompts_come_back_as_they_were(self, prompts):
        texts = TextStore()
        numbers = [texts.block(prompt) for prompt in prompts]
        data = {"blocks": texts.blocks, "lines": texts.lines}
        assert [block(data, number) for number in numbers] == prompts

    def test_what_prompts_share_is_stored_once(self):
        texts = TextStore()
        for number in range(100):
            texts.block("\n".join([*(f"rule {line}" for line in range(500)), f"now {number}"]))
        assert len(texts.lines) == 600
        assert max(len(stretches) for stretches in texts.blocks) == 4

    def test_endless_texts_are_cut_and_say_so(self):
        texts = TextStore()
        assert texts.lines[texts.line("x" * (LONGEST + 5))].endswith(f"[cut: {LONGEST + 5} characters]")


class TestKeySteps:
    def test_joining_and_the_end_are_always_there(self):
        result = watched(3).result
        steps = {key.step: key.captions for key in key_steps(result)}
        assert steps[3] == ("newcomer joins",)
        assert steps[4] == ("newcomer takes Apple (1)",)
        assert steps[5] == ("newcomer puts Apple (1) in place",)
        assert steps[12] == ("step limit reached",)

    def test_the_most_telling_ones_are_kept(self):
        assert [key.step for key in key_steps(watched(3).result, 3)] == [3, 5, 12]
