"""What a robot and its person say to each other: what is shown, asked, refused and counted."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable
from functools import partial

from adhoc.agents.human.board import Board
from adhoc.agents.human.commands import Command, CommandReader, GoOn
from adhoc.agents.human.person import LEAVE, MAX_CHARACTERS, Person
from adhoc.core.errors import CommandError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Context
from adhoc.prompting.clean import one_line

_HEARD = 8


class Dialog:
    """The talk of one episode.

    Args:
        person: Who answers.
        board: Draws what the person sees.
        reader: Reads what it types.
        tries: So many lines in a row may be no commands.
        context: The robot's situation now.
        doing: What it is at, as text.
    """

    def __init__(
        self,
        person: Person,
        board: Board,
        reader: CommandReader,
        tries: int,
        context: Callable[[], Context],
        doing: Callable[[], str],
    ) -> None:
        self._person, self._board, self._reader, self._tries = person, board, reader, tries
        self._context, self._doing = context, doing
        self.happened: list[str] = []
        """What the person has not been told yet."""
        self._heard: deque[Message] = deque(maxlen=_HEARD)
        self.counts: Counter[str] = Counter()
        """Since they were last taken; see `evaluation.person_counts`."""
        self._shown_at = -1

    def hear(self, inbox: Iterable[Message]) -> None:
        """What others say is shown when the person is asked next, the latest of it."""
        self._heard.extend(message for message in inbox if message.kind is not MessageKind.TEAM)

    def next_command(self, step: int) -> Command | None:
        """What the person wants; None if none of its lines was a command."""
        view = partial(self._view, step)
        for _ in range(self._tries):
            answer = self._person.ask(view, step)
            self.happened.clear()
            self._heard.clear()
            if not answer.is_typed:
                return GoOn()
            self.counts.update(lines=1, strayed=int(answer.is_strayed))
            try:
                return self._reader.read(answer.text)
            except CommandError as error:
                self.counts["refused"] += 1
                view = partial(str, f"  {error}")
        self._person.tell(f"  After {self._tries} lines that were no commands the robot waits for a step.")
        return None

    def own_words(self, question: Message, step: int) -> str | None:
        """The person's words before the robot's answer to a question; None if it leaves."""
        asked = one_line(f"{question.sender} asks: {question.text}", MAX_CHARACTERS)
        view = partial(str, f"  {asked}")
        answer = self._person.ask(view, step, "your answer (Enter: what your robot knows)> ")
        self.counts.update(lines=1, strayed=int(answer.is_strayed))
        return None if answer.text == LEAVE else answer.text

    def show(self, text: str) -> None:
        """Show something that was asked for."""
        self._person.tell(text)

    def show_all(self) -> None:
        """Show everything that the robot knows."""
        self._person.tell(self._board.draw(self._context(), self._doing(), all_of_it=True))

    def take_counts(self) -> dict[str, int]:
        """What was counted since this was last asked for, without zeros."""
        counts, self.counts = +self.counts, Counter()
        return dict(counts)

    def _view(self, step: int) -> str:
        """Everything when the person is asked first in a step, then only what has happened since."""
        if self._shown_at == step:
            return "\n".join(f"  happened: {one_line(it, MAX_CHARACTERS)}" for it in self.happened)
        self._shown_at = step
        return self._board.draw(self._context(), self._doing(), self.happened, tuple(self._heard))
