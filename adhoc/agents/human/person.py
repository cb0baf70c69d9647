"""Where a robot's commands come from: a script, or a person at the terminal whose lines are recorded."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from adhoc.agents.human.script import Answer, Line, Script, SessionLog
from adhoc.agents.human.situation import Situation
from adhoc.agents.human.terminal import Terminal
from adhoc.core.errors import ConfigurationError
from adhoc.prompting.clean import one_line

LEAVE = "leave"
"""What the end of the input stands for."""
MAX_CHARACTERS = 500
PROMPT = "> "


class Person:
    """Answers one robot in one episode.

    Without a script the person is asked at the terminal. What is typed goes to the log of the session, and
    where the log has the very situation already, nobody is asked: what was typed then is taken again. So an
    episode that was interrupted goes on where it stopped, and the past that the team alone shares with the
    team and a newcomer is played once.

    Args:
        me: The robot that is played.
        situation: What the robot has gone through.
        heading: Names the episode in the log.
        introduction: What the person is shown first, under the heading.
        script: Where all lines are taken from; None for the terminal.
        script_key: What a script is given by, for errors.
        sessions: The folder of logs, a file for each robot name; None for none.
        repeat: Whether what is in the log is taken again.
        terminal: Where to ask; a fresh one by default.

    Raises:
        ConfigurationError: The log cannot be read.
    """

    def __init__(
        self,
        me: str,
        situation: Situation,
        heading: str,
        introduction: str,
        script: Script | None,
        script_key: str,
        sessions: Path | None,
        repeat: bool = True,
        terminal: Terminal | None = None,
    ) -> None:
        self._situation = situation
        self._script, self._script_key = script, script_key
        path = None if sessions is None else sessions / (re.sub(r"[^\w.-]+", "_", me) + ".txt")
        has_past = script is None and repeat and path is not None and path.exists()
        self._past = Script(path, "session") if has_past and path is not None else None
        self._log = None if path is None or script is not None else SessionLog(path, heading)
        self._terminal = terminal
        self._has_met = False
        self._heading, self._introduction = heading, introduction

    def ask(self, view: Callable[[], str], step: int, prompt: str = PROMPT) -> Answer:
        """A line of the person's, or of the script; `LEAVE` when there is none any more.

        `view` makes what the person sees first. It is made for a script as well: things get their short
        numbers when they are shown. Raises ConfigurationError where there is no person at all: the terminal
        is empty (`Terminal.is_empty`).
        """
        shown = view()
        if self._script is not None:
            answer = self._script.answer(step, self._situation.digest) or Answer(LEAVE)
        else:
            answer = Answer(self._typed(shown, prompt))
        if answer.is_typed:
            if self._log is not None:
                self._log.add(Line(answer.text, step, self._situation.digest))
            self._situation.type(answer.text)
        return answer

    def tell(self, text: str) -> None:
        """Show something that needs no answer; a script sees nothing."""
        if self._script is None:
            self._at_terminal().show(f"{text}\n")

    def _typed(self, view: str, prompt: str) -> str:
        terminal = self._at_terminal()
        terminal.show(f"{view}\n" if view else "")
        recorded = None if self._past is None else self._past.recorded(self._situation.digest)
        if recorded is not None:
            terminal.show(f"{prompt}{recorded}   (as before)\n")
            return recorded
        typed = terminal.ask(prompt)
        if terminal.is_empty:
            raise ConfigurationError(
                f"no person: standard input is empty; give +{self._script_key}=FILE, or run at a terminal"
            )
        return LEAVE if typed is None else one_line(typed, MAX_CHARACTERS)

    def _at_terminal(self) -> Terminal:
        if self._terminal is None:
            self._terminal = Terminal()
        if not self._has_met:
            self._has_met = True
            self._terminal.show(
                f"\n=== You play {self._heading}. `help` lists what you can type. ===\n{self._introduction}\n"
            )
        return self._terminal
