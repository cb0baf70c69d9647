"""A language model's common sense: what records say of it, resumed runs, the report, and the referee."""

from __future__ import annotations

import json
from typing import ClassVar

import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario
from test_records import record

from adhoc.core.values import Action, ActionName
from adhoc.evaluation.common_sense import (
    Agreement,
    agreements,
    judgement_counts,
)
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import run_comparison
from adhoc.llm.counting import CountingModel
from adhoc.llm.episode_model import EpisodeModel
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.model import LanguageModel, LMResponse, Usage
from adhoc.llm.scripted import ScriptedModel
from adhoc.reporting.agreement_table import agreement_table
from adhoc.tasks.llm_common_sense import LLMCommonSense
from adhoc.tasks.placement import PlacementCommonSense

ASKED = ("Apple", "Knife", "Pillow")
ONLY_BED = json.dumps({"places": [{"receptacle": "Bed", "room_types": ["Bedroom"]}]})


class Moody(LanguageModel):
    """Answers something else each time that it is asked, be it the same."""

    name = "moody"

    def __init__(self) -> None:
        self.asked = 0

    def complete(self, request):
        self.asked += 1
        room_type = ("Bedroom", "Kitchen", "Bathroom", "LivingRoom")[self.asked % 4]
        text = json.dumps({"places": [{"receptacle": "Bed", "room_types": [room_type]}]})
        return LMResponse(text, self.name, Usage(100 + self.asked, 10))


class SensibleErrand(Errand):
    """The errand of `grid_world`, with somebody to ask where things belong."""

    def __init__(self, common_sense) -> None:
        self._common_sense = common_sense

    @property
    def common_sense(self):
        return self._common_sense


class Asker(Script):
    """Asks at every third step, and turns one way or the other by the answer."""

    def reset(self, me, capability, task, seed, ask):
        super().reset(me, capability, task, seed, ask)
        self.task = task

    def act(self, observation, inbox):
        turn = super().act(observation, inbox)
        category = ASKED[observation.step // 3 % len(ASKED)]
        if self.task.common_sense.is_misplaced(category, "Bed", "Bedroom"):
            return type(turn)(Action(ActionName.ROTATE_LEFT), turn.outbox)
        return turn


def run(folder, backend, newcomer=True, scenarios=(0, 1)):
    """A comparison in which the robots ask `backend`, by way of a ledger in the run folder."""
    model = CountingModel(EpisodeModel(LedgerModel(backend, folder / "ledger")))
    conditions = Conditions(
        SensibleErrand(LLMCommonSense(model)),
        Contender("askers", "Askers", lambda seat: Asker(), {"name": "askers"}),
        max_steps=12,
        settings={"task": "sensible"},
        model=model,
    )
    helper = Contender(
        "helper", "Helper", lambda seat: Script(*fetch("apple", "counter")), {"name": "helper"}
    )
    where = [scenario(id=f"two_rooms-s{seed}", seed=seed) for seed in scenarios]
    entrants = (Entrant(helper, 5),) if newcomer else ()
    run_comparison(Comparison(GridWorld(), where, conditions, entrants), RunFolder(folder))
    return records(folder)


def records(folder):
    return [comparable(it) for it in RecordFile(folder).read()]


def comparable(one):
    llm = {key: value for key, value in one["llm"].items() if key not in ("replayed", "latency_s")}
    return {**one, "wall_s": 0, "llm": llm}


class TestRecords:
    def test_every_record_counts_what_its_own_episode_asked(self, tmp_path):
        moody = Moody()
        found = run(tmp_path, moody)
        assert len(found) == 4
        assert {it["llm"]["calls"] for it in found} == {len(ASKED)}
        assert {it["common_sense"]["asked"] for it in found} == {len(ASKED)}
        assert {it["model"] for it in found} == {"moody"}
        assert moody.asked == len(ASKED), "the answers are kept for the run"

    def test_a_resumed_run_has_the_records_of_an_uninterrupted_one(self, tmp_path):
        """Also if it is killed before any record is written, or between any two of them."""
        whole = run(tmp_path, Moody())
        path = tmp_path / "episodes.jsonl"
        lines = path.read_bytes().splitlines(keepends=True)
        for kept in range(len(lines)):
            path.write_bytes(b"".join(lines[:kept]))
            moody = Moody()
            assert run(tmp_path, moody) == whole
            assert moody.asked == 0

    def test_a_record_does_not_depend_on_the_episodes_before_it(self, tmp_path):
        whole = run(tmp_path / "whole", Moody())
        assert run(tmp_path / "second", Moody(), scenarios=(1,)) == whole[2:]

    def test_without_a_judge_there_is_nothing_to_say(self):
        assert judgement_counts(None) is None
        assert judgement_counts(PlacementCommonSense()) is None

    def test_judgements_are_held_against_the_table(self):
        sense = LLMCommonSense(ScriptedModel([ONLY_BED, ONLY_BED, "what?", ONLY_BED]), repairs=0)
        sense.is_misplaced("Pillow", "Bed", "Bedroom")
        sense.is_misplaced("Pillow", "Fridge", "Kitchen")
        sense.is_misplaced("Pillow", "Sofa", "LivingRoom")
        sense.is_misplaced("Fork", "Bed", "Bedroom")
        sense.is_misplaced("Spoon", "Fridge", "Kitchen")
        sense.is_misplaced("Unheard", "Bed", "Bedroom")
        assert judgement_counts(sense) == {
            "judge": "scripted",
            "asked": 5,
            "agreed": 2,
            "false_misplaced": 1,
            "false_in_place": 1,
            "unanswered": 1,
        }


class TestReport:
    COUNTS: ClassVar = {
        "asked": 10,
        "agreed": 7,
        "false_misplaced": 2,
        "false_in_place": 1,
        "unanswered": 0,
    }
    RECORDS: ClassVar = [
        record(0, common_sense={"judge": "tiny", **COUNTS}),
        record(1, common_sense={"judge": "tiny", **COUNTS, "asked": 11, "unanswered": 1}),
        record(2, common_sense={"judge": "big", **dict.fromkeys(COUNTS, 0)}),
        record(3, common_sense=None),
        record(4),
    ]

    def test_records_are_summed_by_judge(self):
        assert agreements(self.RECORDS) == {"tiny": Agreement(21, 14, 4, 2, 1), "big": Agreement()}
        assert agreements(self.RECORDS)["tiny"].accuracy == pytest.approx(200 / 3)

    def test_the_table_names_every_judge(self):
        table = agreement_table(self.RECORDS)
        assert table is not None
        assert [[cell.text for cell in row.cells] for row in table.groups[0]] == [
            ["big", "-", "0", "0", "0", "0"],
            ["tiny", "66.7", "4", "2", "1", "21"],
        ]

    def test_without_a_judge_there_is_no_table(self):
        assert agreement_table(self.RECORDS[3:]) is None


class TestReferee:
    @pytest.mark.parametrize(
        "places", ["[]", '[{"receptacle": "Bed", "room_types": ["Bedroom", "Kitchen"]}]']
    )
    def test_the_referee_goes_by_the_table_whatever_the_model_says(self, tmp_path, places):
        """The apple and the knife belong on the counter for the table alone."""

        class Stubborn(Moody):
            def complete(self, request):
                return LMResponse(f'{{"places": {places}}}', self.name, Usage(1, 1))

        model = CountingModel(Stubborn())
        conditions = Conditions(
            SensibleErrand(LLMCommonSense(model)),
            Contender("askers", "Askers", lambda seat: Script(), {}),
            max_steps=30,
            model=model,
        )
        steps = fetch("apple", "counter") + fetch("knife", "counter")
        helper = Contender("helper", "Helper", lambda seat: Script(*steps), {})
        comparison = Comparison(GridWorld(), [scenario()], conditions, (Entrant(helper, 0),))
        run_comparison(comparison, RunFolder(tmp_path))
        assert records(tmp_path)[1]["success"] is True
