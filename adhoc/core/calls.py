"""Sub-tasks and sub-skills as values: a vocabulary of call specifications, and calls that fill them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

Argument = str | float


class ParameterKind(str, Enum):
    """What an argument refers to, so that prompts and parsers can check it."""

    OBJECT = "object"
    RECEPTACLE = "receptacle"
    ROOM = "room"
    RECEPTACLE_TYPE = "receptacle type"
    ROOM_TYPE = "room type"
    NUMBER = "number"


@dataclass(frozen=True)
class Parameter:
    """One parameter of a sub-task or a sub-skill, as the paper's <ID_room> or <Type_receptacle>."""

    name: str
    kind: ParameterKind


@dataclass(frozen=True)
class CallSpec:
    """One kind of sub-task or sub-skill that a planner may choose, described for people and models.

    `steps` is the usual course of a sub-task in sub-skills, with the parameters' names in braces,
    e.g. `"PickupObject {object}"`; a name in braces that is no parameter stands for whatever the
    step needs and the planner must find (`{target}`). Planners read it as text.
    """

    name: str
    parameters: tuple[Parameter, ...]
    description: str
    needs_manipulation: bool = False
    steps: tuple[str, ...] = ()

    @property
    def signature(self) -> str:
        """The name with its parameters, e.g. `Explore <room>`."""
        return " ".join([self.name, *(f"<{parameter.name}>" for parameter in self.parameters)])


@dataclass(frozen=True)
class Call:
    """A chosen sub-task or sub-skill: a name of the vocabulary and its arguments in order."""

    name: str
    args: tuple[Argument, ...] = ()

    def __str__(self) -> str:
        return " ".join([self.name, *map(_format_argument, self.args)])


SubTask = Call
SubSkill = Call


@dataclass(frozen=True)
class TaskBrief:
    """What planners and prompts need to know of a task: its texts and vocabularies.

    `examples` holds in-context examples per stage (`generate`, `evaluate`, `reflect`, `sub_skill`,
    `negotiate`).
    `fallback` is the safe choice when no candidate survives.
    """

    name: str
    description: str
    sub_tasks: tuple[CallSpec, ...]
    sub_skills: tuple[CallSpec, ...]
    fallback: Call
    examples: Mapping[str, str] = field(default_factory=dict)


def _format_argument(argument: Argument) -> str:
    return argument if isinstance(argument, str) else f"{argument:g}"
