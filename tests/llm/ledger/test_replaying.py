from __future__ import annotations

import pytest
from recorded_calls import Counting, Interrupted, asked, outcome, record, reply_format

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.replaying import ReplayModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.testing.model_contract import LanguageModelContract

REQUESTS = [asked("a"), asked("b"), asked("a"), asked("!cut"), asked("!empty"), asked("a", agent="r2")]


class TestReplayModel(LanguageModelContract):
    @pytest.fixture(autouse=True)
    def _folder(self, tmp_path):
        self.folder = tmp_path
        model = LedgerModel(ScriptedModel(["an answer"] * 3), tmp_path)
        for _ in range(3):
            model.complete(self.request())

    def model(self):
        return ReplayModel(self.folder)


@pytest.fixture
def recorded(tmp_path):
    return record(tmp_path, *REQUESTS)


def test_a_replay_gives_what_was_recorded_from_one_file_or_a_folder(tmp_path, recorded):
    (file,) = tmp_path.iterdir()
    before = file.read_bytes()
    for path in (tmp_path, file):
        model = ReplayModel(path)
        for _ in range(2):
            model.begin_episode("e1", 0)
            assert [outcome(model, request) for request in REQUESTS] == recorded
    assert file.read_bytes() == before
    assert list(tmp_path.iterdir()) == [file]


def test_order_does_not_matter(tmp_path, recorded):
    model = ReplayModel(tmp_path)
    other = [outcome(model, REQUESTS[place]) for place in (5, 4, 3, 1, 0, 2)]
    assert other == [recorded[place] for place in (5, 4, 3, 1, 0, 2)]


def test_equal_requests_of_one_robot_may_not_go_together(tmp_path, recorded):
    model = ReplayModel(tmp_path)
    assert model.may_go_together([asked("a"), asked("b")])
    assert not model.may_go_together([asked("a"), asked("a")])


def test_name_and_window_are_the_recorded_models(tmp_path, recorded):
    model = ReplayModel(tmp_path)
    assert (model.name, model.window) == ("counting-1", 9000)
    assert model.complete(asked("a")).model == "counting-1"
    assert model.complete(asked("b")).replayed


def test_tokens_are_counted_as_they_were(tmp_path, recorded):
    messages = [ChatMessage("user", "seven c")]
    assert ReplayModel(tmp_path).count_tokens(messages) == 2 + 4
    assert ReplayModel(tmp_path, counts_like=Counting()).count_tokens(messages) == 77


def test_settings_come_from_the_ledger(tmp_path):
    LedgerModel(Counting(), tmp_path, {"temperature": 0.3}).complete(asked())
    assert ReplayModel(tmp_path).complete(asked()).text == "answer 1 to Where to?"


@pytest.mark.parametrize(
    ("request_", "told"),
    [
        (asked("a", template="t1"), r"same messages has another template \('' there, 't1' here\)"),
        (asked("b", seed=8), r"another seed \(7 there, 8 here\)"),
        (asked("b", temperature=1.0), r"another temperature \(None there, 1.0 here\)"),
        (
            asked("b", sample=3, max_tokens=9),
            r"another max_tokens \(1024 there, 9 here\), another sample \(0 t",
        ),
        (asked("b", reply=reply_format()), r"another schema \(None there, '[0-9a-f]+' here\)"),
        (asked("b", model="m2"), r"another model \('counting-1' there, 'm2' here\)"),
        (asked("b", stage="reflect", messages=()), "no call of stage 'reflect' is recorded at all"),
        (
            asked("!cup"),
            r"of 'r1' in episode 'e1'\) has another message 2: from character 3 on 't' there, 'p' here",
        ),
        (
            asked(messages=(*asked("b").messages, ChatMessage("user", "and now?"))),
            "another message 3: from character 0 on no message there, 'and now\\?' here",
        ),
        (
            asked(messages=asked("b").messages[:1]),
            "another message 2: from character 0 on 'a' there, no message here",
        ),
    ],
)
def test_a_miss_says_who_asked_and_what_is_nearest(tmp_path, recorded, request_, told):
    model = ReplayModel(tmp_path)
    who = rf"no answer to a call of stage '{request_.stage}', agent 'r1' and episode 'e1' \(key [0-9a-f]+\)"
    with pytest.raises(LedgerError, match=f"{who}; .*{told}"):
        model.complete(request_)


def test_asking_once_more_than_recorded_is_a_miss(tmp_path, recorded):
    model = ReplayModel(tmp_path)
    model.complete(asked("b"))
    with pytest.raises(LedgerError, match=r"another repeat \(0 there, 1 here\)"):
        model.complete(asked("b"))


def test_calls_that_failed_or_were_interrupted_are_told(tmp_path):
    record(tmp_path, asked("!busy"))
    with pytest.raises(KeyboardInterrupt):
        LedgerModel(Interrupted(), tmp_path).complete(asked("slow"))
    model = ReplayModel(tmp_path)
    with pytest.raises(LedgerError, match="was made, but failed: ModelBusy: the provider has a fault"):
        model.complete(asked("!busy"))
    with pytest.raises(LedgerError, match="was made, but never answered"):
        model.complete(asked("slow"))


def test_the_first_answer_counts(tmp_path):
    early, late = LedgerModel(Counting(), tmp_path), LedgerModel(Counting(), tmp_path)
    early.complete(asked("b"))
    late.complete(asked("other"))
    late.complete(asked("yet another"))
    early.complete(asked("a"))
    late.complete(asked("a"))
    assert ReplayModel(tmp_path).complete(asked("a")).text == "answer 2 to a"
    late.complete(asked("c"))
    early.complete(asked("c"))
    assert ReplayModel(tmp_path).complete(asked("c")).text == "answer 3 to c"


def test_no_ledger_is_told(tmp_path):
    with pytest.raises(LedgerError, match="holds no ledger; a run writes one to OUT/ledger"):
        ReplayModel(tmp_path)
    with pytest.raises(LedgerError, match=r"none: there is no such file or folder"):
        ReplayModel(tmp_path / "none")


def test_of_several_models_one_is_chosen(tmp_path):
    record(tmp_path, asked("a"))
    LedgerModel(ScriptedModel(["from the other"]), tmp_path).complete(asked("a"))
    with pytest.raises(LedgerError, match="several models: say which of 'counting-1', 'scripted'"):
        ReplayModel(tmp_path)
    with pytest.raises(LedgerError, match="no calls of model 'gpt', but of 'counting-1', 'scripted'"):
        ReplayModel(tmp_path, model="gpt")
    assert ReplayModel(tmp_path, model="scripted").complete(asked("a")).text == "from the other"
    assert ReplayModel(tmp_path, model="counting-1").complete(asked("a")).text == "answer 1 to a"


def test_of_several_settings_none_is_guessed(tmp_path):
    LedgerModel(Counting(), tmp_path, {"temperature": 0.3}).complete(asked())
    LedgerModel(Counting(), tmp_path, {"temperature": 0.7}).complete(asked())
    with pytest.raises(
        LedgerError, match=r"with several settings, {'temperature': 0.3} and {'temperature': 0.7}"
    ):
        ReplayModel(tmp_path)
    assert ReplayModel(tmp_path, settings={"temperature": 0.3}).complete(asked()).replayed


def test_a_model_that_was_set_up_otherwise_is_not_replayed(tmp_path):
    """Its records would say that the answers are those of another temperature."""
    LedgerModel(Counting(), tmp_path, {"temperature": 0.3}).complete(asked())
    with pytest.raises(LedgerError, match=r"other settings: temperature \(0\.3 there, 0\.7 here\)"):
        ReplayModel(tmp_path, settings={"temperature": 0.7})
