"""What became of an episode."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from adhoc.core.errors import BudgetReached
from adhoc.core.values import Pose
from adhoc.evaluation.scenario import Scenario
from adhoc.evaluation.trace import Trace
from adhoc.evaluation.transit import Deliveries


class Ending(str, Enum):
    """Why an episode ended."""

    REPLACED = "all misplaced objects re-placed"
    STOPPED = "all robots stopped or out of battery"
    MAX_STEPS = "step limit reached"
    BUDGET = "budget reached"
    """A robot's question to a language model could have passed a cap. Such an episode failed, however far it
    came, if the cap is one of the episode; it is unfinished if the cap is the run's."""


@dataclass(frozen=True)
class EpisodeResult:
    """What became of one episode, before any score is made of it."""

    scenario: Scenario
    max_steps: int
    ending: Ending
    steps: int
    """Steps that were run."""
    watched: tuple[str, ...]
    """Ids of the objects that the episode is about: the misplaced ones."""
    replaced: tuple[str, ...]
    """Ids of the misplaced objects that ended in a right place."""
    join_step: int | None
    """The step at which the newcomer was to join; None for the team alone."""
    joined: bool
    """Whether it did: an episode that ends before `join_step` never sees it."""
    joined_at: Pose | None
    """Where it entered."""
    moved: bool
    """Whether that is not the planned pose, because it was occupied."""
    agent_steps: Mapping[str, int]
    """Battery steps used by every robot that was in the episode."""
    messages: int
    undeliverable: int
    history: tuple[str, ...]
    """One hash a step, see `evaluation.history`."""
    trace: Trace
    budget: BudgetReached | None = None
    """The cap that ended it, for `Ending.BUDGET`."""
    deliveries: Deliveries = field(default_factory=Deliveries)
    """What a faulty radio did to messages, counted for each robot that they were sent to."""
    broke_down: Mapping[str, int] = field(default_factory=dict)
    """The robots that broke down, and before which step."""
    left: Mapping[str, int] = field(default_factory=dict)
    """Those that were taken away, likewise."""
    understood: Mapping[str, int] = field(default_factory=dict)
    """Messages that a stranger can understand, by dialect (see `evaluation.understanding`)."""
    not_understood: int = 0
    """Those that stay text."""

    @property
    def success(self) -> bool:
        return self.ending is Ending.REPLACED

    @property
    def history_hash(self) -> str:
        """The hash of everything before the newcomer joined, or of the whole episode if it did not."""
        joined_after = self.join_step if self.joined and self.join_step is not None else -1
        return self.history[joined_after]
