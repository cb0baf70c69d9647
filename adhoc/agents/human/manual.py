"""What a person is told beforehand: the task, the robot, and what can be typed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from adhoc.agents.human.commands import KEYS
from adhoc.core.calls import CallSpec
from adhoc.core.values import Capability
from adhoc.prompting.clean import one_line
from adhoc.tasks.task import Task

_LONGEST = 200


def introduction(task: Task, capability: Capability) -> str:
    """Two lines: the beginning of the task's description, and what the robot can do.

    The battery is the only limit of steps that a robot knows of; an episode may be shorter.
    """
    goal, dot, _ = task.description.partition(". ")
    hand = (
        f"can pick up things of up to {capability.payload:.1f} kg"
        if capability.can_manipulate
        else "has no hand: it cannot pick up anything"
    )
    moves = "" if capability.can_navigate else "cannot move, "
    return (
        f"Task: {one_line(goal + dot.strip(), _LONGEST)} (`help` tells more)\n"
        f"Your robot {moves}{hand}; its battery lasts {capability.max_steps} steps, one for each action."
    )


def help_text(task: Task, can_manipulate: bool) -> str:
    """The whole task, and what can be typed."""
    keys = ", ".join(f"{key} {action.value}" for key, action in KEYS.items())
    lines = [
        f"Task: {task.description}",
        "Sub-skills, by name or the beginning of it, with ids or their numbers (`go 3`, `explore`):",
        *_vocabulary(task.sub_skills, can_manipulate),
        "`do NAME ...` begins a sub-skill that is called like another command (`do stop`).",
        f"Single actions: {keys}; several in a row (`wwwa`) or with a count (`w 3`); "
        + ("`pickup 3`, `putdown 5`, `drop`;" if can_manipulate else "")
        + " names of actions too.",
        "`say TEXT` tells everybody; `wait N` looks around for N steps; Enter goes on with what is being",
        "done; `look` shows all that your robot knows; `stop` stops it for good; `leave` ends your part.",
        "`task SUB-TASK` tells the team what you are about, `task none` that it is nothing any more:",
        *_vocabulary(task.sub_tasks, can_manipulate),
    ]
    return "\n".join(lines)


def _vocabulary(specs: Iterable[CallSpec], can_manipulate: bool) -> Iterator[str]:
    for spec in specs:
        if can_manipulate or not spec.needs_manipulation:
            yield f"  {spec.signature}: {spec.description}"
