"""The page in a real browser: it loads, plays, and complains about nothing."""

from __future__ import annotations

import pytest
from browser import dom_of, find_browser, self_test
from watched_grid import HOSTILE, watched

from adhoc.inspecting.page import write_page


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    find_browser()
    folder = tmp_path_factory.mktemp("page")
    write_page([watched(None, HOSTILE), watched(3, HOSTILE)], folder / "page.html")
    return self_test(folder / "page.html", folder / "profile")


def test_it_loads_without_a_complaint(told):
    assert told["troubles"] == []
    assert (told["episodes"], told["steps"]) == (2, 12)


def test_the_slider_moves_the_picture_and_back(told):
    assert told["sliderMoves"]
    assert told["back"]


def test_it_plays_and_obeys_the_keyboard(told):
    assert told["played"] >= 1
    assert told["keyboard"]


def test_messages_decisions_prompts_and_pictures_are_shown(told):
    assert told["messages"] > 10
    assert told["decisions"] == 3
    assert told["prompts"] >= 6
    assert told["pictures"] == 3
    assert all(letters > 20 for letters in told["panels"].values()), told["panels"]


def test_hostile_text_stays_text(told):
    assert told["foreign"] == 0
    assert told["scripts"] == 2
    assert told["title"] == "two_rooms-s0--walkers--alone"


def test_nothing_is_cut_off_at_the_side(told):
    assert told["wide"] is False


def test_titles_of_two_policies_side_by_side_are_not_cut(tmp_path):
    """In a window of 1280 pixels, and at the end, when what is told beside the titles is longest."""
    first, second = watched(3), watched(4)
    first.record["policy_label"] = "IRoT w/o Ev. & Rf. (GPT-3.5)"
    second.record["policy_label"] = "IRoT w/o Ev. & Rf. (GPT-4.1 mini)"
    write_page([first, second], tmp_path / "page.html")
    assert self_test(tmp_path / "page.html", tmp_path / "profile")["cutTitles"] == []


def test_episodes_of_one_policy_have_titles_of_their_own(tmp_path):
    episodes = [watched(None), watched(3), watched(4), watched(4), watched(4), watched(4)]
    episodes[3].record["model"] = "gpt-4.1-mini"
    for beside in episodes[4:]:
        beside.record["team_label"] = "Learned"
    write_page(episodes, tmp_path / "page.html")
    assert self_test(tmp_path / "page.html", tmp_path / "profile")["titles"] == [
        "Team alone",
        "With Thinker t3",
        "With Thinker t4 thinker beside Walkers",
        "With Thinker t4 gpt-4.1-mini",
        "With Thinker t4 thinker beside Learned #5",
        "With Thinker t4 thinker beside Learned #6",
    ]


def test_a_page_that_is_damaged_says_so(tmp_path):
    page = tmp_path / "page.html"
    write_page([watched(None)], page)
    text = page.read_text(encoding="utf-8")
    start = text.index('type="text/plain">') + len('type="text/plain">')
    page.write_text(text[:start] + "eJz" + text[start + 40 :], encoding="utf-8")
    assert "The page could not be shown" in dom_of(page, tmp_path / "profile").split("<script")[0]
