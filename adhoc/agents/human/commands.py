"""What a person may type, and what it means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from adhoc.agents.human.names import ArgumentCountError, Names
from adhoc.core.calls import Call, CallSpec
from adhoc.core.errors import CommandError
from adhoc.core.values import MANIPULATION, Action, ActionName, Capability, Failure
from adhoc.prompting.clean import one_line
from adhoc.tasks.task import Task

KEYS = {
    "w": ActionName.MOVE_AHEAD,
    "s": ActionName.MOVE_BACK,
    "a": ActionName.MOVE_LEFT,
    "d": ActionName.MOVE_RIGHT,
    "q": ActionName.ROTATE_LEFT,
    "e": ActionName.ROTATE_RIGHT,
    "r": ActionName.LOOK_UP,
    "f": ActionName.LOOK_DOWN,
}
"""Keys of single actions; several in a row are done one after the other."""
MAX_ACTIONS = 100
"""The most steps of one command."""
WAIT = Action(ActionName.ROTATE_RIGHT)
"""A step of waiting: no action does nothing, so a robot that waits looks around."""

_ACTIONS = {name.value.casefold(): name for name in ActionName}
_TARGETED = frozenset({ActionName.PICK_UP, ActionName.PUT_DOWN})
_SHOWN = 60
_OTHERS = ("say TEXT", "task SUB-TASK", "do SUB-SKILL", "wait", "look", "help", "stop", "leave", "Enter")
_WITHOUT = {
    "say": "the text is missing: `say TEXT` tells it to everybody.",
    "task": "the sub-task is missing: `task SUB-TASK` tells the team of it, `task none` that there is none.",
    "do": "the sub-skill is missing: `do NAME ...` begins it.",
}


@dataclass(frozen=True)
class DoSkill:
    """Begin a sub-skill."""

    call: Call


@dataclass(frozen=True)
class DoActions:
    """Do low-level actions, one a step."""

    actions: tuple[Action, ...]


@dataclass(frozen=True)
class Intend:
    """Tell the team what this robot is about; None: nothing any more."""

    sub_task: Call | None


@dataclass(frozen=True)
class Say:
    """Say something to everybody."""

    text: str


@dataclass(frozen=True)
class Show:
    """Show something to the person: `help`, or `look` for all that the robot knows."""

    what: str


@dataclass(frozen=True)
class GoOn:
    """Go on with what is being done, or wait a step."""


@dataclass(frozen=True)
class Stop:
    """Stop for good."""


@dataclass(frozen=True)
class Leave:
    """The person leaves, and the robot is on its own."""


Command = DoSkill | DoActions | Intend | Say | Show | GoOn | Stop | Leave


class CommandReader:
    """Reads lines as commands.

    Args:
        task: Its sub-skills can be done, its sub-tasks told.
        capability: What the robot can do.
        names: What arguments may name.
    """

    def __init__(self, task: Task, capability: Capability, names: Names) -> None:
        self._task, self._capability, self._names = task, capability, names

    def read(self, line: str) -> Command:
        """The command of a line; an empty one is to go on. Raises CommandError with a sentence to show."""
        verb, *words = line.split() or [""]
        match verb.casefold():
            case "":
                return GoOn()
            case "say" | "task" | "do" as command if not words:
                raise CommandError(_WITHOUT[command])
            case "help" | "look" | "leave" as command if words:
                raise CommandError(f"`{command}` stands alone, nothing comes after it.")
            case "say":
                return Say(line.split(None, 1)[1])
            case "help" | "look" as command:
                return Show(command)
            case "stop" if not words:
                return Stop()
            case "leave":
                return Leave()
            case "wait":
                return DoActions((WAIT,) * _count(words, verb))
            case "task":
                return Intend(self._sub_task(words))
            case "do":
                return DoSkill(self._skill(words[0], words[1:]))
        return self._actions(verb, words) or DoSkill(self._skill(verb, words))

    def _actions(self, verb: str, words: list[str]) -> DoActions | None:
        """Low-level actions: keys, or the name of one; None if it is no such thing."""
        if not set(verb) - set(KEYS):
            count = _count(words, verb) if len(verb) == 1 else 1
            if len(verb) > MAX_ACTIONS or (len(verb) > 1 and words):
                raise CommandError(f"{_shown(verb)}: keys stand alone, at most {MAX_ACTIONS} of them.")
            return DoActions(tuple(self._action(KEYS[key], []) for key in verb) * count)
        name = _ACTIONS.get(verb.casefold())
        if name is None or name is ActionName.STOP:
            return None
        if name in _TARGETED:
            return DoActions((self._action(name, words),))
        return DoActions((self._action(name, []),) * _count(words, verb))

    def _action(self, name: ActionName, words: list[str]) -> Action:
        able = self._capability.can_manipulate if name in MANIPULATION else self._capability.can_navigate
        if not able:
            lacking = Failure.NO_MANIPULATION if name in MANIPULATION else Failure.NO_NAVIGATION
            raise CommandError(f"{name.value}: {lacking.value}.")
        if name not in _TARGETED:
            return Action(name)
        if len(words) != 1:
            raise CommandError(f"{name.value} takes one target, e.g. `{name.value.lower()} 3`.")
        return Action(name, self._names.target(words[0]))

    def _sub_task(self, words: list[str]) -> Call | None:
        if [word.casefold() for word in words] == ["none"]:
            return None
        call = self._call(words[0], words[1:], self._task.sub_tasks, "sub-task")
        return self._legal(call, self._task.legal(call, self._capability))

    def _skill(self, verb: str, words: list[str]) -> Call:
        call = self._call(verb, words, self._task.sub_skills, "sub-skill")
        return self._legal(call, self._task.legal_skill(call, self._capability))

    def _legal(self, call: Call, refusal: str | None) -> Call:
        if refusal is not None:
            raise CommandError(f"{call}: {refusal}.")
        return call

    def _call(self, verb: str, words: list[str], specs: Sequence[CallSpec], what: str) -> Call:
        """The call that is meant: names may be cut short, as long as the arguments fit one of them only."""
        meant = [it for it in specs if it.name.casefold() == verb.casefold()]
        if not meant and len(verb) > 1:  # one letter, such as a key with Caps Lock on, begins no name
            meant = [it for it in specs if it.name.casefold().startswith(verb.casefold())]
        if not meant:
            raise CommandError(self._unknown(verb, specs, what))
        fitting: list[Call] = []
        refusals: list[str] = []
        counts: list[str] = []
        for spec in meant:
            try:
                fitting.append(self._names.call(spec, words))
            except ArgumentCountError as error:
                counts.append(str(error))
            except CommandError as error:
                refusals.append(f"{spec.name}: {error}")
        if not fitting and not refusals:
            forms = " or ".join(f"`{spec.signature}`" for spec in meant)
            raise CommandError(counts[0] if len(meant) == 1 else f"{_shown(verb)} must be one of {forms}.")
        if not fitting:
            raise CommandError(" ".join(refusals))
        if len(fitting) > 1:
            raise CommandError(f"{_shown(verb)} could be {' or '.join(map(str, fitting))}.")
        return fitting[0]

    def _unknown(self, verb: str, specs: Sequence[CallSpec], what: str) -> str:
        able = self._capability.can_manipulate
        known = ", ".join(it.name for it in specs if able or not it.needs_manipulation)
        if what == "sub-task":
            return f"{_shown(verb)} is no sub-task; `help` explains them. There are: {known}, none."
        actions = [it.value for it in ActionName if it is not ActionName.STOP]
        if not able:
            actions = [it for it in actions if ActionName(it) not in MANIPULATION]
        return (
            f"{_shown(verb)} is no command; `help` explains all of them. Sub-skills: {known}. "
            f"Actions: {', '.join(actions)}, keys {' '.join(KEYS)}. Others: {', '.join(_OTHERS)}."
        )


def _count(words: list[str], verb: str) -> int:
    if not words:
        return 1
    word = words[0]
    is_number = word.isascii() and word.isdigit() and len(word) < 6
    if len(words) > 1 or not is_number or not 1 <= int(word) <= MAX_ACTIONS:
        raise CommandError(f"after {_shown(verb)} only a number from 1 to {MAX_ACTIONS} may come.")
    return int(word)


def _shown(word: str) -> str:
    return f"`{one_line(word, _SHOWN)}`"
