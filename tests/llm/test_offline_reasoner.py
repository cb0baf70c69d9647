"""The offline reasoner: it knows what the prompt says, and nothing else."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import pytest
from fake_situation import BRIEF, CONTEXT, KNOWLEDGE, SEARCH, parcel, receptacle
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.calls import Call, CallSpec
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.plans import Assessment, Candidate, Context, Event
from adhoc.core.values import Capability, RoomRecord
from adhoc.llm.model import LMRequest
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.prompting.library import shipped_prompts
from adhoc.prompting.stage import Prediction, StageInput
from adhoc.testing.model_contract import LanguageModelContract

DELIVERY = Call("Deliver", ("Letter|1", "Tray", "Office"))
SEARCHER = TeammateView("t", sub_task=Call("Search", ("room|3",)))
ALONE = replace(CONTEXT, teammates=(), messages=())


def flawless(**arguments: Any) -> OfflineReasoner:
    rates = {"forget_capability": 0.0, "ignore_teammate": 0.0, "ignore_reply": 0.0, **arguments}
    return OfflineReasoner(KNOWLEDGE, **rates)


def prompt(template: str, context: Context, drop: Iterable[str] = (), **stage: Any) -> LMRequest:
    messages = []
    for message in shipped_prompts().render(template, context, StageInput(**stage)):
        lines = [line for line in message.content.split("\n") if not any(it in line for it in drop)]
        messages.append(ChatMessage(message.role, "\n".join(lines)))
    return LMRequest(tuple(messages), template)


def ask(template: str, context: Context, drop: Iterable[str] = (), **stage: Any) -> dict[str, Any]:
    return json.loads(flawless().complete(prompt(template, context, drop, **stage)).text)


def proposed(context: Context, count: int = 3, drop: Iterable[str] = ()) -> list[str]:
    entries = ask("generate", context, drop, count=count)["sub_tasks"]
    return [" ".join([it["name"], *it["args"]]) for it in entries]


def skill(context: Context, sub_task: Call, drop: Iterable[str] = (), last: Assessment | None = None) -> str:
    entry = ask("sub_skill", replace(context, sub_task=sub_task), drop, sub_task=sub_task, last=last)[
        "sub_skill"
    ]
    return " ".join([entry["name"], *entry["args"]])


def judged(context: Context, sub_task: Call, *replies: str) -> tuple[bool, str]:
    messages = tuple(Message(MessageKind.REPLY, it, {}, "robot_0", "teammate_2", 12) for it in replies)
    answer = ask("reflect", context, chosen=Candidate(sub_task), replies=messages)
    return answer["feasible"], answer["reason"]


class TestContract(LanguageModelContract):
    def model(self) -> OfflineReasoner:
        return OfflineReasoner(KNOWLEDGE)


class TestGeneration:
    def test_the_nearest_needed_object_then_rooms(self) -> None:
        assert proposed(CONTEXT) == ["Deliver Letter|1 Tray Office", "Search room|3", "Search room|4"]

    def test_what_a_teammate_is_at_is_left_alone(self) -> None:
        assert "Deliver Letter|2 Tray Office" in proposed(ALONE)
        assert not any("Letter|2" in it for it in proposed(CONTEXT, 9))

    def test_what_a_teammate_holds_is_left_alone(self) -> None:
        holder = TeammateView("t", holding="Letter|1")
        assert not any("Letter|1" in it for it in proposed(replace(CONTEXT, teammates=(holder,)), 9))

    def test_a_teammate_that_has_stopped_claims_nothing(self) -> None:
        stopped = replace(CONTEXT.teammates[0], stopped=True)
        assert "Deliver Letter|2 Tray Office" in proposed(replace(CONTEXT, teammates=(stopped,)), 9)

    def test_what_is_too_heavy_stays(self) -> None:
        assert not any("Box|1" in it for it in proposed(ALONE, 9))
        strong = replace(ALONE, capability=Capability(payload=10.0))
        assert "Deliver Box|1 Shelf Archive" in proposed(strong, 9)

    def test_without_hands_it_searches(self) -> None:
        handless = replace(ALONE, capability=Capability(can_manipulate=False))
        assert proposed(handless) == ["Search room|3", "Search room|4"]

    def test_what_is_in_the_hand_comes_first(self) -> None:
        full = replace(ALONE, holding="Letter|2")
        assert proposed(full)[0] == "Deliver Letter|2 Tray Office"
        assert not any("Letter|1" in it for it in proposed(full, 9))

    def test_a_room_that_a_teammate_searches_comes_after_the_others(self) -> None:
        busy = TeammateView("t", sub_task=Call("Search", ("room|3",)))
        rooms = [it for it in proposed(replace(CONTEXT, teammates=(busy,)), 9) if "Search" in it]
        assert rooms == ["Search room|4", "Search room|3"]

    def test_a_room_in_which_a_teammate_stands_counts_as_farther(self) -> None:
        context = replace(
            ALONE,
            objects=(),
            rooms=(RoomRecord("room|3", None, (4.0, 1.0)), RoomRecord("room|4", None, (5.0, 1.0))),
        )
        assert proposed(context) == ["Search room|3", "Search room|4"]
        there = TeammateView("t", room="room|3")
        assert proposed(replace(context, teammates=(there,))) == ["Search room|4", "Search room|3"]

    def test_the_last_resort_comes_only_when_nothing_is_left(self) -> None:
        done = replace(CONTEXT, objects=(), rooms=(RoomRecord("room|1", explored=True),))
        assert proposed(done) == ["Rest"]

    def test_the_place_is_a_known_one_even_if_another_is_likelier(self) -> None:
        archive = replace(CONTEXT.rooms[2], room_type="Archive")
        shelf = receptacle("Shelf|1", "Shelf", (5.0, 2.0), "room|3")
        context = replace(ALONE, objects=(CONTEXT.objects[0], shelf), rooms=(CONTEXT.rooms[0], archive))
        assert proposed(context)[0] == "Deliver Letter|1 Shelf Archive"

    def test_a_thing_is_not_brought_to_where_it_lies(self) -> None:
        letter = replace(CONTEXT.objects[0], receptacle="Tray|2", receptacle_category="Tray", room="room|2")
        context = replace(ALONE, objects=(letter, *CONTEXT.objects[1:]), holding=None)
        done = (Call("Approach", ("Letter|1",)), Call("Grab", ("Letter|1",)))
        assert skill(replace(context, done=done), DELIVERY) == "Approach Tray|1"

    def test_what_failed_three_times_comes_last(self) -> None:
        history = tuple(Event(it, "Grab Letter|1 failed: blocked") for it in range(3))
        assert proposed(replace(ALONE, history=history[:2]), 1) == ["Deliver Letter|1 Tray Office"]
        assert proposed(replace(ALONE, history=history), 1) == ["Deliver Letter|2 Tray Office"]
        held = replace(ALONE, history=history, holding="Letter|1")
        assert proposed(held, 1) == ["Deliver Letter|1 Tray Office"]

    def test_what_was_refused_at_this_step_is_not_proposed_again(self) -> None:
        refusal = "judged infeasible: Deliver Letter|1 Tray Office (because: teammate_2 has it)"
        assert "Deliver Letter|1 Tray Office" not in proposed(
            replace(CONTEXT, history=(Event(12, refusal),)), 9
        )
        assert "Deliver Letter|1 Tray Office" in proposed(replace(CONTEXT, history=(Event(11, refusal),)), 9)


class TestItKnowsNothingButThePrompt:
    """A fact that is taken out of the prompt's text is missing from the plan."""

    def test_without_the_object_it_is_not_delivered(self) -> None:
        assert not any("Letter|1" in it for it in proposed(CONTEXT, 9, drop=["- Letter|1;"]))

    def test_without_the_teammate_its_object_is_taken(self) -> None:
        assert any("Letter|2" in it for it in proposed(CONTEXT, 9, drop=["- teammate_1;"]))

    def test_without_its_capability_it_dares_nothing(self) -> None:
        assert not any("Deliver" in it for it in proposed(CONTEXT, 9, drop=["- manipulation: yes"]))

    def test_without_its_payload_it_lifts_everything(self) -> None:
        assert any("Box|1" in it for it in proposed(CONTEXT, 9, drop=["- payload: 5 kg"]))

    def test_without_the_room_it_is_not_searched(self) -> None:
        assert "Search room|3" not in proposed(CONTEXT, 9, drop=["- room|3;"])

    def test_without_the_vocabulary_there_is_nothing_to_propose(self) -> None:
        assert not any("Deliver" in it for it in proposed(CONTEXT, 9, drop=["- Deliver <object>"]))

    def test_without_the_receptacles_it_searches_for_one(self) -> None:
        context = replace(ALONE, holding="Letter|1", rooms=CONTEXT.rooms[:2])
        assert skill(context, DELIVERY) == "Approach Tray|2"
        assert skill(context, DELIVERY, drop=["- room|2 (Office)"]) == "LookAround"

    def test_without_the_usual_course_it_only_looks_around(self) -> None:
        assert skill(ALONE, DELIVERY, drop=["- usual course"]) == "LookAround"

    def test_without_the_memory_of_a_failure_it_fails_again(self) -> None:
        failed = Event(11, "Leave Letter|1 Tray|2 room|2 failed: there is no free place")
        context = replace(ALONE, holding="Letter|1", history=(failed,))
        assert skill(context, DELIVERY) == "Approach Tray|1"
        assert skill(context, DELIVERY, drop=["failed"]) == "Approach Tray|2"

    def test_the_stage_name_of_the_request_means_nothing(self) -> None:
        request = prompt("generate", CONTEXT, count=3)
        other = replace(request, stage="reflect")
        assert flawless().complete(request) == flawless().complete(other)

    def test_a_text_that_is_no_prompt_gives_an_empty_object(self) -> None:
        request = LMRequest((ChatMessage("user", "Tell me a joke."),), "generate")
        assert flawless().complete(request).text == "{}"


class TestEvaluation:
    def test_ranks_by_need_and_puts_what_is_out_of_the_question_last(self) -> None:
        candidates = (
            Candidate(Call("Deliver", ("Letter|2", "Tray", "Office"))),
            Candidate(Call("Search", ("room|4",))),
            Candidate(Call("Search", ("room|3",))),
            Candidate(DELIVERY),
        )
        assert ask("evaluate", CONTEXT, candidates=candidates)["ranking"] == [3, 2, 1, 0]

    def test_the_whole_way_counts_where_generation_sees_the_way_to_the_thing(self) -> None:
        """Letter|1 is nearer; but its tray is unknown, and that of Box|1 is at hand."""
        light = parcel("Box|1", "Box", (3.0, 1.0), "room|1")
        shelf = receptacle("Shelf|1", "Shelf", (3.0, 2.0), "room|3")
        rooms = (CONTEXT.rooms[0], replace(CONTEXT.rooms[2], explored=True))
        context = replace(ALONE, objects=(CONTEXT.objects[0], light, shelf), rooms=rooms)
        first, second = (
            Call("Deliver", ("Letter|1", "Tray", "Office")),
            Call("Deliver", ("Box|1", "Shelf", "Archive")),
        )
        ask_for = (Candidate(first), Candidate(second))
        assert ask("evaluate", context, candidates=ask_for)["ranking"] == [1, 0]
        assert ask("evaluate", context, ["Shelf|1 [Shelf"], candidates=ask_for)["ranking"] == [0, 1]

    def test_a_free_teammate_that_is_nearer_makes_it_less_worth(self) -> None:
        letters = (
            parcel("Letter|1", "Letter", (2.0, 1.0), "room|1"),
            parcel("Letter|2", "Letter", (1.0, 3.0), "room|1"),
        )
        ask_for = [Candidate(Call("Deliver", (it.id, "Tray", "Office"))) for it in letters]
        helper = TeammateView("t", Capability(), position=(2.0, 1.1))
        context = replace(ALONE, objects=(*letters, *CONTEXT.objects[4:]))
        assert ask("evaluate", context, candidates=ask_for)["ranking"] == [0, 1]
        helped = replace(context, teammates=(helper,))
        assert ask("evaluate", helped, candidates=ask_for)["ranking"] == [1, 0]
        busy = replace(context, teammates=(replace(helper, holding="Box|1"),))
        assert ask("evaluate", busy, candidates=ask_for)["ranking"] == [0, 1]

    @pytest.mark.parametrize(
        ("better", "worse", "changes"),
        [
            (Call("Search", ("room|4",)), DELIVERY, {"capability": Capability(can_manipulate=False)}),
            (Call("Search", ("room|4",)), Call("Deliver", ("Box|1", "Shelf", "Archive")), {}),
            (Call("Search", ("room|4",)), DELIVERY, {"holding": "Letter|2"}),
            (Call("Search", ("room|4",)), Call("Deliver", ("Letter|3", "Tray", "Office")), {}),
            (Call("Search", ("room|4",)), Call("Search", ("room|2",)), {}),
            (Call("Search", ("room|4",)), Call("Search", ("room|3",)), {"teammates": (SEARCHER,)}),
            (Call("Search", ("room|4",)), Call("Rest"), {}),
            (Call("Deliver", ("Letter|2", "Tray", "Office")), DELIVERY, {"holding": "Letter|2"}),
            (Call("Rest"), Call("Fly"), {}),
            (
                Call("Deliver", ("Letter|3", "Shelf", "Archive")),
                Call("Search", ("room|3",)),
                {"holding": "Letter|3"},
            ),
            (
                Call("Search", ("room|4",)),
                Call("Search", ("room|3",)),
                {"history": tuple(Event(it, "WalkTo room|3 failed: blocked") for it in (5, 6))},
            ),
            (DELIVERY, Call("Search", ("room|3",)), {}),
        ],
    )
    def test_ability_conflict_need_and_progress(
        self, better: Call, worse: Call, changes: dict[str, Any]
    ) -> None:
        context = replace(CONTEXT, teammates=CONTEXT.teammates[1:])
        context = replace(context, **changes)
        for order, expected in (((worse, better), [1, 0]), ((better, worse), [0, 1])):
            ask_for = [Candidate(it) for it in order]
            assert ask("evaluate", context, candidates=ask_for)["ranking"] == expected

    def test_scores_fall_with_the_rank(self) -> None:
        candidates = (Candidate(Call("Search", ("room|4",))), Candidate(DELIVERY))
        scores = {
            it["index"]: it["score"] for it in ask("gpl_score", CONTEXT, candidates=candidates)["scores"]
        }
        assert scores[1] > scores[0] > 0

    def test_a_predicted_plan_counts_as_the_teammate_s_own(self) -> None:
        candidates = (Candidate(DELIVERY), Candidate(Call("Search", ("room|4",))))
        predictions = (Prediction("teammate_2", DELIVERY),)
        answer = ask("gpl_score", CONTEXT, candidates=candidates, predictions=predictions)
        assert {it["index"]: it["score"] for it in answer["scores"]}[0] == 0

    def test_a_predicted_plan_is_left_alone_by_generation_too(self) -> None:
        predictions = (Prediction("teammate_2", DELIVERY),)
        answer = ask("gpl_generate", CONTEXT, count=9, predictions=predictions)
        assert all("Letter|1" not in it["args"] for it in answer["sub_tasks"])
        assert any("Letter|1" in it["args"] for it in ask("gpl_generate", CONTEXT, count=9)["sub_tasks"])

    def test_predicts_that_teammates_go_on(self) -> None:
        first = ask("gpl_predict", CONTEXT)["predictions"][0]
        assert first["sub_task"] == {"name": "Deliver", "args": ["Letter|2", "Tray", "Office"]}
        assert first["sub_skill"] == {"name": "Grab", "args": ["Letter|2"]}


class TestReflection:
    @pytest.mark.parametrize(
        "reply",
        [
            "Current sub-task: Deliver Letter|1 Tray Office.",
            "Explored rooms: none. I hold Letter|1.",
            "Letter|1 is gone.",
            "Detected objects: Letter|1 (well placed Letter) at Tray|1 in room|2.",
            "I am already taking Letter|1 to the tray",
        ],
    )
    def test_an_object_that_somebody_has_or_that_is_gone(self, reply: str) -> None:
        feasible, reason = judged(CONTEXT, DELIVERY, reply)
        assert not feasible
        assert "teammate_2" in reason

    @pytest.mark.parametrize(
        "reply",
        [
            "Explored rooms: none. Detected objects: none. Current sub-task: none.",
            "Current sub-task: Deliver Letter|11 Tray Office.",
            "Detected objects: Letter|1 (misplaced Letter) at Chair|1; Letter|3 (well placed Letter).",
            "I see Letter|1 (misplaced Letter), Letter|3 (well placed Letter).",
        ],
    )
    def test_replies_that_say_nothing_against_it(self, reply: str) -> None:
        assert judged(CONTEXT, DELIVERY, reply)[0]

    def test_a_room_that_is_explored(self) -> None:
        search = Call("Search", ("room|3",))
        assert not judged(CONTEXT, search, "Explored rooms: room|2, room|3. Current sub-task: none.")[0]
        assert judged(CONTEXT, search, "Explored rooms: room|2, room|33. Current sub-task: none.")[0]
        assert judged(CONTEXT, search, "I have not yet explored room|3.")[0]

    def test_a_room_that_somebody_searches_only_if_something_else_is_left(self) -> None:
        search, reply = Call("Search", ("room|3",)), "Current sub-task: Search room|3."
        assert not judged(CONTEXT, search, reply)[0]
        nothing_else = replace(CONTEXT, objects=(), rooms=CONTEXT.rooms[:3], teammates=())
        assert judged(nothing_else, search, reply)[0]

    def test_rest_only_when_nothing_is_left(self) -> None:
        assert not judged(CONTEXT, Call("Rest"))[0]
        assert judged(replace(CONTEXT, objects=(), rooms=()), Call("Rest"))[0]

    @pytest.mark.parametrize(
        ("changes", "feasible"),
        [
            ({}, False),
            ({"capability": Capability(can_manipulate=False)}, True),
            ({"capability": Capability(payload=0.1)}, True),
            ({"teammates": (TeammateView("t", sub_task=DELIVERY),)}, True),
            ({"teammates": (TeammateView("t", holding="Letter|1"),)}, True),
        ],
    )
    def test_rest_only_while_nothing_that_it_can_handle_is_left_alone(
        self, changes: dict[str, Any], feasible: bool
    ) -> None:
        """Even what was refused at this step for another reason is left to do."""
        refused = tuple(
            Event(12, f"judged infeasible: Deliver Letter|1 {place} (because: I do not feel like it)")
            for place in ("Tray Office", "Shelf Archive")
        )
        context = replace(ALONE, objects=CONTEXT.objects[:1], rooms=CONTEXT.rooms[:2], history=refused)
        assert judged(replace(context, **changes), Call("Rest"))[0] is feasible

    @pytest.mark.parametrize(
        "reason",
        ["teammate_2 says that it is handling Letter|1", "t says that Letter|1 needs nothing any more"],
    )
    def test_a_refusal_that_tells_of_somebody_excuses_resting(self, reason: str) -> None:
        refused = Event(12, f"judged infeasible: {DELIVERY} (because: {reason})")
        context = replace(ALONE, objects=CONTEXT.objects[:1], rooms=CONTEXT.rooms[:2], history=(refused,))
        assert judged(context, Call("Rest"))[0]
        assert not judged(replace(context, history=(replace(refused, step=11),)), Call("Rest"))[0]

    def test_its_own_abilities_and_knowledge_count_too(self) -> None:
        handless = replace(CONTEXT, capability=Capability(can_manipulate=False))
        assert "manipulation" in judged(handless, DELIVERY)[1]
        assert "too heavy" in judged(CONTEXT, Call("Deliver", ("Box|1", "Shelf", "Archive")))[1]
        assert "explored" in judged(CONTEXT, Call("Search", ("room|2",)))[1]
        assert "gone" in judged(replace(CONTEXT, objects=()), DELIVERY)[1]


class TestSubSkills:
    def test_follows_the_usual_course(self) -> None:
        grab, near = Call("Grab", ("Letter|1",)), Call("Approach", ("Letter|1",))
        tray = Call("Approach", ("Tray|2",))
        assert skill(ALONE, DELIVERY) == "Approach Letter|1"
        assert skill(replace(ALONE, done=(near,)), DELIVERY) == "Grab Letter|1"
        held = replace(ALONE, done=(near, grab), holding="Letter|1")
        assert skill(held, DELIVERY) == "Approach Tray|2"
        assert skill(replace(held, done=(near, grab, tray)), DELIVERY) == "Leave Letter|1 Tray|2 room|2"

    def test_begins_later_with_the_object_in_its_hand(self) -> None:
        assert skill(replace(ALONE, holding="Letter|1"), DELIVERY) == "Approach Tray|2"

    def test_searches_a_room_until_it_is_done(self) -> None:
        search = Call("Search", ("room|3",))
        there = (Call("WalkTo", ("room|3",)),)
        assert skill(ALONE, search) == "WalkTo room|3"
        assert skill(replace(ALONE, done=there), search) == "LookAround"
        assert skill(replace(ALONE, done=(*there, Call("LookAround"))), search) == "LookAround"

    def test_goes_to_a_room_of_the_wanted_type_when_no_receptacle_is_known(self) -> None:
        box = Call("Deliver", ("Box|1", "Shelf", "Archive"))
        held = replace(ALONE, holding="Box|1")
        assert skill(held, box) == "WalkTo room|3"
        assert skill(replace(held, room="room|3"), box) == "LookAround"

    def test_goes_to_a_room_of_unknown_type_when_none_of_the_wanted_type_is_left(self) -> None:
        rooms = (*CONTEXT.rooms[:2], replace(CONTEXT.rooms[2], explored=True), CONTEXT.rooms[3])
        held = replace(ALONE, holding="Box|1", rooms=rooms)
        assert skill(held, Call("Deliver", ("Box|1", "Shelf", "Archive"))) == "WalkTo room|4"

    def test_looks_around_once_after_a_failure(self) -> None:
        last = Assessment(False, "Approach Letter|1 failed: the way is blocked")
        assert skill(ALONE, DELIVERY, last=last) == "LookAround"
        assert skill(ALONE, DELIVERY, last=Assessment(True, "LookAround succeeded")) == "Approach Letter|1"

    def test_rests_when_told_so(self) -> None:
        assert skill(ALONE, Call("Rest")) == "Rest"

    def test_without_a_sub_task_it_finds_one_for_itself(self) -> None:
        assert ask("direct_sub_skill", CONTEXT)["sub_skill"] == {"name": "Approach", "args": ["Letter|1"]}
        held = replace(CONTEXT, holding="Letter|1", done=(Call("Grab", ("Letter|1",)),))
        assert ask("direct_sub_skill", held)["sub_skill"] == {"name": "Approach", "args": ["Tray|2"]}

    def test_names_mean_nothing(self) -> None:
        """The same plan under another vocabulary: rules go by kinds and by what the prompt says."""
        renamed = replace(SEARCH, name="Xyzzy", steps=("Foo {room}", "Bar"))
        brief = replace(
            BRIEF,
            sub_tasks=(renamed, CallSpec("Plugh", (), "", steps=("Quux",))),
            sub_skills=(
                CallSpec("Foo", SEARCH.parameters, ""),
                CallSpec("Quux", (), ""),
                CallSpec("Bar", (), ""),
            ),
        )
        context = replace(CONTEXT, task=brief)
        assert proposed(context) == ["Xyzzy room|3", "Xyzzy room|4"]
        assert skill(context, Call("Xyzzy", ("room|3",))) == "Foo room|3"
        failed = Assessment(False, "Foo room|3 failed: blocked")
        assert skill(context, Call("Xyzzy", ("room|3",)), last=failed) == "Bar"


class TestMistakes:
    def test_the_same_prompt_gives_the_same_answer(self) -> None:
        request = prompt("generate", CONTEXT, count=3)
        assert OfflineReasoner(KNOWLEDGE).complete(request) == OfflineReasoner(KNOWLEDGE).complete(request)

    def test_forgetting_a_capability(self) -> None:
        handless = replace(ALONE, capability=Capability(can_manipulate=False))
        answer = flawless(forget_capability=1.0).complete(prompt("generate", handless, count=3))
        assert "Deliver" in answer.text

    def test_overlooking_a_teammate(self) -> None:
        context = replace(CONTEXT, teammates=CONTEXT.teammates[:1])
        answer = flawless(ignore_teammate=1.0).complete(prompt("generate", context, count=9))
        assert "Letter|2" in answer.text

    def test_skipping_a_reply(self) -> None:
        reply = Message(MessageKind.REPLY, "I hold Letter|1.", {}, "robot_0", "teammate_2", 12)
        request = prompt("reflect", CONTEXT, chosen=Candidate(DELIVERY), replies=(reply,))
        assert json.loads(flawless().complete(request).text)["feasible"] is False
        assert json.loads(flawless(ignore_reply=1.0).complete(request).text)["feasible"] is True

    def test_the_rate_is_the_rate_and_depends_on_seed_and_sample(self) -> None:
        handless = replace(ALONE, capability=Capability(can_manipulate=False))
        request = prompt("generate", handless, count=3)

        def forgot(seed: int, sample: int) -> bool:
            model = flawless(forget_capability=0.3, seed=seed)
            return "Deliver" in model.complete(replace(request, sample=sample)).text

        by_seed = sum(forgot(seed, 0) for seed in range(400))
        by_sample = sum(forgot(0, sample) for sample in range(400))
        assert 90 < by_seed < 150
        assert 90 < by_sample < 150

    def test_mistakes_do_not_depend_on_the_variant(self) -> None:
        """The stand-in must not make one policy win: without an analysis it is as careful as with one."""
        handless = replace(ALONE, capability=Capability(can_manipulate=False))
        model = flawless(forget_capability=0.4)
        wrong = {
            template: sum(
                "Deliver" in model.complete(replace(prompt(template, handless), sample=it)).text
                for it in range(200)
            )
            for template in ("naive", "cot")
        }
        assert all(55 < count < 105 for count in wrong.values())

    @pytest.mark.parametrize("name", ["forget_capability", "ignore_teammate", "ignore_reply"])
    def test_rates_are_probabilities(self, name: str) -> None:
        with pytest.raises(ConfigurationError, match=name):
            OfflineReasoner(KNOWLEDGE, **{name: 1.5})


def test_its_name_says_what_it_is() -> None:
    assert flawless().name == "offline (not a language model)"
    assert flawless().complete(prompt("generate", CONTEXT)).model == "offline (not a language model)"


def test_tokens_are_a_quarter_of_the_characters() -> None:
    request = LMRequest((ChatMessage("user", "12345678"),), "generate")
    usage = flawless().complete(request).usage
    assert (usage.prompt_tokens, usage.completion_tokens, usage.cost_usd) == (2, 1, 0.0)


@given(st.lists(st.text(), max_size=3), st.sampled_from(["generate", "reflect", "sub_skill", "gpl_score"]))
def test_no_text_makes_it_fail(texts: list[str], template: str) -> None:
    stage = StageInput(sub_task=DELIVERY, chosen=Candidate(DELIVERY))
    whole = [it.content for it in shipped_prompts().render(template, CONTEXT, stage)]
    for contents in (texts, [*whole, *texts], [whole[0], *texts], [it[: len(it) // 2] for it in whole]):
        request = LMRequest(tuple(ChatMessage("user", it) for it in contents), template)
        assert isinstance(json.loads(flawless().complete(request).text), dict)


def test_hostile_lines_in_known_sections_are_only_unknown() -> None:
    text = """## Teammates
- ;
- a;
## Rooms
- x; distance: far
## Receptacles by room
- z (
## Your memory
- step 12: judged infeasible:
- step 12: judged infeasible:  (because: of it)
## Generated sub-tasks
- 0: (because: of it)
## Output format
{"analysis", "ranking"}
## Chosen sub-task
-
## Your state at step inf
- position: (.., ..)"""
    request = LMRequest((ChatMessage("user", text),), "evaluate")
    assert json.loads(flawless().complete(request).text)["ranking"] == [0]


def test_parcels_far_from_a_free_helper_are_preferred() -> None:
    helper = TeammateView("t", Capability(), position=(2.0, 1.1))
    context = replace(
        CONTEXT,
        objects=(
            parcel("Letter|1", "Letter", (2.0, 1.0), "room|1"),
            parcel("Letter|2", "Letter", (1.0, 3.0), "room|1"),
        ),
        teammates=(),
    )
    assert proposed(context, 1) == ["Deliver Letter|1 Tray Office"]
    assert proposed(replace(context, teammates=(helper,)), 1) == ["Deliver Letter|2 Tray Office"]
