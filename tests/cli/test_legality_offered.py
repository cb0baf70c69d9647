"""Stages that ask for `legal` or `legal_skill` are given the task's own checks."""

from __future__ import annotations

import inspect
from typing import ClassVar

import pytest
from hydra import compose, initialize_config_dir

from adhoc.cli.contestants import Components
from adhoc.cli.schema import register_schema
from adhoc.core.calls import Call
from adhoc.core.resources import data_dir
from adhoc.core.values import Capability
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.gpl import GPLGenerator
from adhoc.planning.legality import Legal
from adhoc.planning.sub_skill import LLMSubSkillPlanner

HANDLESS = Capability(can_manipulate=False)


class Recording(LLMSubSkillPlanner):
    """Remembers what it was given."""

    given: ClassVar[list[Legal]] = []

    def __init__(self, model, legal, legal_skill):
        super().__init__(model, legal_skill=legal_skill)
        self.given[:] = [legal, legal_skill]


def test_both_checks_are_the_task_s():
    register_schema()
    overrides = ["policy=irot", f"policy.sub_skill_planner._target_={__name__}.Recording"]
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        newcomer = Components(compose("run", overrides)).newcomer
    assert newcomer is not None
    legal, legal_skill = Recording.given
    assert "manipulation" in str(legal(Call("Re-place", ("a", "Bed", "Bedroom")), HANDLESS))
    assert "manipulation" in str(legal_skill(Call("PickupObject", ("a",)), HANDLESS))
    assert "not a sub-task" in str(legal(Call("PickupObject", ("a",)), HANDLESS))


@pytest.mark.parametrize(
    ("stage", "parameter"),
    [(LLMGenerator, "legal"), (GPLGenerator, "legal"), (LLMSubSkillPlanner, "legal_skill")],
)
def test_the_shipped_stages_ask_for_them(stage, parameter):
    assert parameter in inspect.signature(stage).parameters
