"""What is recorded beside a team: the expert's decisions, and how the teammates behaved."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.features import FEATURE_SIZE
from adhoc.agents.learned.shipped import common_sense_in
from adhoc.agents.plastic.deeds import Heard
from adhoc.agents.plastic.models import DECISION, HEARD, SEEN
from adhoc.agents.plastic.newcomer import LearnedNewcomer
from adhoc.agents.plastic.situation import FEATURES
from adhoc.agents.plastic.watching import Behaviour
from adhoc.core.streams import stream
from adhoc.dataset.making.parallel import Progress
from adhoc.evaluation.scenario import Scenario
from adhoc.training.behaviour_cloning import Examples
from adhoc.training.demonstrations import Cast, Demonstrations, DemonstrationSettings, Recorder, demonstrate
from adhoc.training.expert import Demonstrator, Expert
from adhoc.training.plastic_settings import PlasticTrainingSettings
from adhoc.training.plastic_teams import ExpertBeside, TeamType
from adhoc.training.training_houses import house_draws
from adhoc.worlds.world import World

_PARTS = (DECISION, HEARD, SEEN)
_SIZES = {DECISION: FEATURE_SIZE, HEARD: len(FEATURES), SEEN: len(FEATURES)}
ROW_SIZE = 1 + max(_SIZES.values())
"""A row is the number of the part that it is about, the features of that part, and zeros."""


def demonstrate_beside(
    name: str,
    team: TeamType,
    split: str,
    houses: int,
    settings: PlasticTrainingSettings,
    folder: Path,
    workers: int,
    progress: Progress,
) -> Demonstrations:
    """Episodes of a team of a type with an expert newcomer, recorded; see `demonstrations.demonstrate`."""
    make_cast = partial(
        expert_beside, name, team, settings.team_checkpoints, settings.stray, settings.join_steps
    )
    joining = ".".join(map(str, settings.join_steps))
    title = f"{name}-{settings.stray:g}-{settings.max_steps}-{joining}"
    made = DemonstrationSettings(title, make_cast, ROW_SIZE, settings.scenarios, settings.max_steps)
    return demonstrate(house_draws(split, houses, settings.seed), made, folder, workers, progress)


def expert_beside(
    name: str,
    team: TeamType,
    team_checkpoints: str | None,
    stray: float,
    join_steps: tuple[int, ...],
    world: World,
    scenario: Scenario,
) -> Cast:
    """A team of a type and a newcomer whose every decision is the expert's, see `expert.Demonstrator`.

    When it joins is drawn from `join_steps`.
    """
    generator = stream(scenario.seed, "beside", name)
    join_step = int(generator.choice(join_steps))
    expert = ExpertBeside(Expert(world, scenario), team)
    decisions, behaviours = _Decisions(expert, stray, generator), _Behaviours()
    judge = common_sense_in(team_checkpoints)
    newcomer = LearnedNewcomer(decisions.decide, behaviours.notice, judge)
    return Cast([team.make() for _ in scenario.team], [decisions, behaviours], newcomer, join_step)


def examples_of(shown: Demonstrations, part: str) -> Examples:
    """The recorded rows of one part, as `behaviour_cloning.fit_classifier` takes them."""
    of_part = shown.inputs[:, 0] == _PARTS.index(part)
    return Examples(shown.inputs[of_part, 1 : 1 + _SIZES[part]], shown.labels[of_part])


class _Decisions(Demonstrator):
    def note(self, row: NDArray[np.float32], label: int) -> None:
        super().note(_tagged(DECISION, row), label)


class _Behaviours(Recorder):
    def notice(self, behaviour: Behaviour) -> None:
        part = HEARD if isinstance(behaviour.deed, Heard) else SEEN
        self.note(_tagged(part, behaviour.features), int(behaviour.deed))


def _tagged(part: str, features: NDArray[np.floating]) -> NDArray[np.float32]:
    row = np.zeros(ROW_SIZE, np.float32)
    row[0] = _PARTS.index(part)
    row[1 : 1 + len(features)] = features
    return row
