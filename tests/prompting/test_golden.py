"""Every shipped template on one fixed situation, against golden files.

Run with ADHOC_UPDATE_GOLDEN=1 to write the files anew, then read the difference.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from fake_situation import CONTEXT
from tidying_up_situation import TIDYING_UP_CONTEXT, TIDYING_UP_STAGES

from adhoc.core.calls import Call
from adhoc.core.chat import ChatMessage
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Assessment, Candidate, Objection, Prediction
from adhoc.prompting.library import shipped_prompts
from adhoc.prompting.stage import StageInput

GOLDEN = Path(__file__).parent / "golden"
DELIVERY = Call("Deliver", ("Letter|1", "Tray", "Office"))
CANDIDATES = (Candidate(DELIVERY, "it is near"), Candidate(Call("Search", ("room|3",))))
REPLY = Message(MessageKind.REPLY, "Explored rooms: room|3.", {}, "robot_0", "teammate_1", 12)
STAGES = {
    "generate": StageInput(count=3),
    "cot": StageInput(count=1),
    "naive": StageInput(count=1),
    "evaluate": StageInput(candidates=CANDIDATES),
    "reflect": StageInput(chosen=CANDIDATES[0], replies=(REPLY,)),
    "gpl_predict": StageInput(),
    "gpl_generate": StageInput(count=3, predictions=(Prediction("teammate_1", DELIVERY),)),
    "gpl_score": StageInput(candidates=CANDIDATES, predictions=(Prediction("teammate_1", DELIVERY),)),
    "negotiate": StageInput(
        plans={"teammate_1": Call("Search", ("room|3",)), "teammate_2": DELIVERY},
        objections=(Objection("teammate_2", "robot_0", DELIVERY, "## I hold\nLetter|1"),),
        changes=("robot_9 has joined the team at step 50",),
    ),
    "sub_skill": StageInput(sub_task=DELIVERY, last=Assessment(False, "Grab Letter|1 failed: too far away")),
    "direct_sub_skill": StageInput(last=Assessment(True, "Approach Letter|1 succeeded", found=("Tray|3",))),
}


def test_every_template_has_a_golden_file() -> None:
    assert set(shipped_prompts().names) == set(STAGES)
    assert {path.stem for path in GOLDEN.glob("*.txt")} == set(STAGES)


@pytest.mark.parametrize("template", sorted(STAGES))
def test_rendered_prompt_is_the_golden_one(template: str) -> None:
    context = CONTEXT
    if template in ("sub_skill", "direct_sub_skill"):
        context = replace(CONTEXT, sub_task=DELIVERY, done=(Call("Approach", ("Letter|1",)),))
    _compare(GOLDEN / f"{template}.txt", shipped_prompts().render(template, context, STAGES[template]))


@pytest.mark.parametrize("template", sorted(TIDYING_UP_STAGES))
def test_rendered_tidying_up_prompt_is_the_golden_one(template: str) -> None:
    """What a language model is really sent: the task's own brief, with its examples."""
    rendered = shipped_prompts().render(template, TIDYING_UP_CONTEXT, TIDYING_UP_STAGES[template])
    _compare(GOLDEN / "tidying_up" / f"{template}.txt", rendered)


def _compare(path: Path, rendered: Sequence[ChatMessage]) -> None:
    text = "".join(f"--- {message.role} ---\n{message.content}\n" for message in rendered)
    if os.environ.get("ADHOC_UPDATE_GOLDEN"):
        path.write_text(text, encoding="utf-8")
    assert text == path.read_text(encoding="utf-8")
