"""What a stage of planning puts into its prompt besides the context."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.plans import Assessment, Candidate, Prediction


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
