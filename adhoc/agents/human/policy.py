"""A person as the mind of one robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from adhoc.agents.assessment import assess_action
from adhoc.agents.body import SkillTable
from adhoc.agents.communication import task_state_message
from adhoc.agents.context import build_context
from adhoc.agents.decision import doing_trace, skill_trace
from adhoc.agents.human.board import Board
from adhoc.agents.human.commands import (
    WAIT,
    Command,
    CommandReader,
    DoActions,
    DoSkill,
    GoOn,
    Intend,
    Leave,
    Say,
    Show,
    Stop,
)
from adhoc.agents.human.dialog import Dialog
from adhoc.agents.human.errand import Errand
from adhoc.agents.human.manner import Asked, AtEnd, Manner
from adhoc.agents.human.manual import help_text, introduction
from adhoc.agents.human.names import Names
from adhoc.agents.human.person import Person
from adhoc.agents.human.purpose import Purpose
from adhoc.agents.human.script import Script
from adhoc.agents.human.short_numbers import ShortNumbers
from adhoc.agents.human.situation import Situation
from adhoc.agents.human.terminal import Terminal
from adhoc.agents.news import News, merge_news
from adhoc.agents.policy import Ask, Turn
from adhoc.agents.talking import TalkingPolicy
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Context
from adhoc.core.values import Action, ActionName, Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.tasks.task import Task


class HumanPolicy(TalkingPolicy):
    """A person plays the robot (the paper's future work: humans as teammates).

    The person sees the robot's memory as text (`Board`) and types sub-skills, low-level actions, or what to
    say (`CommandReader`); the robot perceives, answers and announces as the other robots do. A person reads
    and types at leisure: the episode waits.

    Args:
        member: Whether the robot belongs to the original team; a newcomer greets the team first.
        asked: See `Asked`.
        answers: Who answers what others ask within a step: `memory`, or `person`: the person may put words
            of its own before what the robot knows.
        at_end: See `AtEnd`.
        tries: So many lines in a step may be no commands; then the robot waits for a step.
        lines: So many lines in a step may do nothing, such as `say`; then likewise.
        script: A file to take lines from; None asks at the terminal.
        sessions: The folder of logs; None for none. A run gives its own.
        repeat: Whether what is in the log is taken again, see `Person`.
        terminal: Where to ask; a fresh one for each episode by default. A run gives its own, which is an
            error if its input is empty from the start.
        configured_at: Where these settings are in a configuration, for errors. A run gives it.
        perception: Settings of the robot's perception.
        skills: Skills by sub-skill name; the paper's seven by default.

    Raises:
        ConfigurationError: An argument is out of range, or the script cannot be read.
    """

    def __init__(
        self,
        member: bool = False,
        asked: str = "events",
        answers: str = "memory",
        at_end: str = "stop",
        tries: int = 5,
        lines: int = 30,
        script: str | None = None,
        sessions: Path | None = None,
        repeat: bool = True,
        terminal: Terminal | None = None,
        configured_at: str = "HumanPolicy",
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
    ) -> None:
        super().__init__(perception, skills)
        self._manner = Manner.of(asked, answers, at_end, tries, lines, configured_at)
        self._member = member
        self._script_key = f"{configured_at}.script"
        self._script = None if script is None else Script(Path(script).expanduser(), self._script_key)
        self._sessions, self._repeat, self._terminal = sessions, repeat, terminal

    @property
    def fingerprint(self) -> str:
        """See `Policy`: of the script's lines. What will be typed at a terminal nobody knows before."""
        scripted = "" if self._script is None else self._script.fingerprint
        return f"{scripted}{super().fingerprint}"

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`. Raises ConfigurationError if the log cannot be read."""
        self._wake(me, capability, task, ask)
        self._errand = Errand(self._memory, self._body)
        self._purpose = Purpose(self._memory, task, capability)
        numbers = ShortNumbers()
        self._situation = Situation(me, capability, seed)
        if self._script is not None:
            self._script.begin()
        person = Person(
            me,
            self._situation,
            f"{me}, seed {seed}",
            introduction(task, capability),
            self._script,
            self._script_key,
            self._sessions,
            self._repeat,
            self._terminal,
        )
        self._dialog = Dialog(
            person,
            Board(numbers),
            CommandReader(task, capability, Names(self._memory, numbers)),
            self._manner.tries,
            self._context,
            lambda: str(self._errand),
        )
        self._events: list[str] = []
        self._begun: list[dict[str, Any]] = []
        self._greeted = self._left = self._stopped = False
        self._held: str | None = None

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`. Raises ConfigurationError if the log cannot be written."""
        self._observation, inbox = observation, self._memory.understand(inbox)
        self._situation.see(observation, inbox)
        self._events, self._begun = [], []
        _, news = self._memory.observe(observation)
        told = self._memory.hear(inbox)
        self._dialog.hear(inbox)
        self._greet()
        self._notice(merge_news(news, told))
        self._report(self._voice.report(news, self._memory.attention()))
        action = self._decide()
        self._announce()
        return self._turn(action, self._trace())

    def respond(self, message: Message) -> Message | None:
        """See `Policy`: what the robot knows, after the person's own words if it is to be asked."""
        if self._observation is None:
            return None
        self._situation.ask(message)
        if message.kind is MessageKind.JOIN:
            self._dialog.happened.append(f"{message.sender} joined: {message.text}")
        answer = super().respond(message)
        if answer is None or self._manner.answers_itself or self._left:
            return answer
        words = self._dialog.own_words(message, self._now.step)
        if words is None:
            self._leave()
        return replace(answer, text=f"{words or ''} {answer.text}".strip())

    # Noticing

    def _greet(self) -> None:
        if not self._member and not self._greeted:
            self._voice.join(self._state())
        self._greeted = True

    def _notice(self, news: News) -> None:
        """What may make the person decide otherwise."""
        last = assess_action(self._now)
        if last is not None and not last.ok and (self._errand.drop_actions() or not self._errand.is_busy):
            self._dialog.happened.append(last.reason)
        for found in (*news.misplaced, *news.told):
            self._dialog.happened.append(f"found: {found} needs attention")
        self._dialog.happened += [f"{name} needs no attention any more" for name in news.settled]
        self._dialog.happened += [f"{name} has stopped" for name in news.stopped]

    # Deciding

    def _decide(self) -> Action:
        if self._stopped or self._now.steps_left <= 0:
            return self._stop()
        due = self._is_due()
        for _ in range(self._manner.lines):
            if not due and self._errand.is_busy:
                action = self._go_on()
                if action is not None:
                    return action
            elif self._left:
                return self._stop() if self._manner.at_end is AtEnd.STOP else WAIT
            else:
                command = self._dialog.next_command(self._now.step)
                if command is None:
                    break
                if isinstance(command, Stop):
                    return self._stop()
                due = not self._obey(command)
        self._dialog.counts["given_up"] += 1
        return WAIT

    def _is_due(self) -> bool:
        """Whether the person is asked in the middle of something."""
        if self._left:
            return False
        return self._manner.asked is Asked.STEPS or (
            self._manner.asked is Asked.EVENTS and bool(self._dialog.happened)
        )

    def _go_on(self) -> Action | None:
        """The next action of what is being done; None if it is over."""
        step = self._errand.next(self._now)
        if isinstance(step, Action):
            return self._stop() if step.name is ActionName.STOP else step
        if step.failure is None:
            self._purpose.succeed(step.call)
        became = "done" if step.failure is None else f"failed: {step.failure}"
        self._dialog.happened.append(f"{step.call} {became}")
        self._events.append(f"{step.call} {became}")
        return None

    def _obey(self, command: Command) -> bool:
        """Whether the robot knows now what to do."""
        match command:
            case GoOn():
                self._errand.go_on()
            case DoActions(actions):
                self._errand.begin_actions(actions)
            case DoSkill(call):
                self._begin(call)
            case Leave():
                self._leave()
            case Say(text):
                self._outbox.append(task_state_message(text, self._state()))
                return False
            case Intend(sub_task):
                self._purpose.tell(sub_task)
                self._events.append(f"My sub-task is now: {sub_task or 'none'}")
                return False
            case Show(what):
                if what == "help":
                    self._dialog.show(help_text(self._task, self._capability.can_manipulate))
                else:
                    self._dialog.show_all()
                return False
        return True

    def _begin(self, call: Call) -> None:
        before = self._purpose.sub_task
        self._purpose.begin(call, self._now)
        if self._purpose.sub_task != before:
            self._events.append(f"My sub-task is now: {self._purpose.sub_task}")
        self._events.append(f"My sub-skill is now: {call}")
        self._begun.append(skill_trace(call, None))
        self._errand.begin_skill(call, self._now, self._purpose.focus_room())

    def _leave(self) -> None:
        self._left = True
        self._dialog.counts["left"] += 1

    def _stop(self) -> Action:
        if not self._stopped:
            self._stopped = True
            self._purpose.tell(None)
            self._errand.end()
            self._events.append("I stop")
        return Action(ActionName.STOP)

    # Talking

    def _announce(self) -> None:
        """What began or ended, and what is in the hand, to everybody."""
        if self._now.held != self._held:
            self._held = self._now.held
            self._events.append(f"I hold {self._held or 'nothing'}")
        self._tell_events(self._events)

    # What is seen

    def _context(self) -> Context:
        purpose = self._purpose
        return build_context(
            self._memory, self._task, self._capability, self._now, purpose.sub_task, tuple(purpose.done)
        )

    def _has_stopped(self) -> bool:
        return self._stopped

    def _doing(self) -> tuple[Call | None, Call | None]:
        return self._purpose.sub_task, self._errand.skill

    def _trace(self) -> dict[str, Any]:
        trace: dict[str, Any] = {"doing": doing_trace(*self._doing())}
        if self._begun:
            trace["skills"] = self._begun
        counts = self._dialog.take_counts()
        if counts:
            trace["person"] = counts
        return trace
