"""What a stage of planning puts into its prompt besides the context."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.plans import Assessment, Candidate, Objection, Prediction


@dataclass(frozen=True)
class StageInput:
    """The subject of one stage; each stage's template says which fields it reads."""

    count: int = 1
    """How many sub-tasks to propose (the paper's n_irot)."""
    candidates: tuple[Candidate, ...] = ()
    """The generated sub-tasks, to be ranked or scored."""
    chosen: Candidate | None = None
    """The sub-task that is judged."""
    replies: tuple[Message, ...] = ()
    """The teammates' replies to the intention."""
    predictions: tuple[Prediction, ...] = ()
    """What the teammates are expected to do next."""
    sub_task: Call | None = None
    """The sub-task whose next sub-skill is wanted."""
    last: Assessment | None = None
    """What became of the last sub-skill."""
    plans: Mapping[str, Call] = field(default_factory=dict)
    """The sub-tasks that members of the team have planned, by robot, in the order of planning."""
    objections: tuple[Objection, ...] = ()
    """What members of the team have against this robot's plan."""
    changes: tuple[str, ...] = ()
    """What has changed in the team, a sentence each."""
