"""How well robots predict what their teammates do next (paper, section Ad hoc Agent Policy, GPL-LLM)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from adhoc.agents.communication import read_call
from adhoc.core.messages import Message
from adhoc.core.values import ActionName

WITHIN = 20
"""Steps in which a predicted change must come. The paper reports no accuracy; see `docs/measures.md`."""
PARTS = ("sub_task", "sub_skill")
MAX_PREDICTIONS = 20_000
STOP = ActionName.STOP.value


@dataclass(frozen=True)
class Forecast:
    """What one robot expected another to do next; None where it expected nothing in particular."""

    step: int
    teammate: str
    sub_task: str | None
    sub_skill: str | None
    of_team: bool
    """Whether a teammate expected it; else the newcomer did."""


@dataclass
class Doings:
    """What every robot did, step by step: what it says of itself in `Turn.trace`, which nobody else can read,
    or else what it tells others. A robot that has stopped does `Stop`."""

    _changes: dict[tuple[str, str], list[tuple[int, str | None]]] = field(default_factory=dict)
    _told: dict[str, int] = field(default_factory=dict)
    """The last step in which a robot told of itself."""
    _stopped: set[str] = field(default_factory=set)

    def tell(self, step: int, robot: str, doing: Mapping[str, Any]) -> None:
        """Take in `Turn.trace["doing"]` of one step."""
        self._told[robot] = step
        for part in PARTS:
            self._note(step, robot, part, doing.get(part))

    def hear(self, messages: Iterable[Message]) -> None:
        """Take in what robots that do not tell of themselves announce."""
        for message in messages:
            if message.sender not in self._told:
                for part in PARTS:
                    if part in message.payload:
                        call = read_call(message.payload[part])
                        self._note(message.step, message.sender, part, None if call is None else str(call))

    def stop(self, step: int, robot: str) -> None:
        """The robot stops for good."""
        if robot not in self._stopped:
            self._stopped.add(robot)
            for part in PARTS:
                self._note(step, robot, part, STOP)

    def next(self, robot: str, part: str, step: int, within: int = WITHIN) -> str | None:
        """What the robot turns to from `step` on: the first thing, within so many steps, that is another than
        what it did before; if there is none, what it does all the time.

        None if that is nothing, or unknown, or if the robot is out of order.
        """
        if robot not in self._stopped and self._told.get(robot, step) < step:
            return None
        before: str | None = None
        for changed, value in self._changes.get((robot, part), ()):
            if changed < step:
                before = value
            elif changed < step + within and value is not None and value != before:
                return value
        return before

    def _note(self, step: int, robot: str, part: str, value: str | None) -> None:
        changes = self._changes.setdefault((robot, part), [])
        if robot in self._stopped and value != STOP:
            return
        if changes and changes[-1][0] == step:
            changes.pop()
        if not changes or changes[-1][1] != value:
            changes.append((step, value))


@dataclass
class Accuracy:
    """Predictions of one part."""

    made: int = 0
    judged: int = 0
    """Those whose teammate then did something that is known."""
    right: int = 0
    """Of the judged: the same call, with the same arguments."""
    named: int = 0
    """Of the judged: a call of the same name; the right ones among them."""

    def count(self, predicted: str, done: str | None) -> None:
        """Hold a prediction against what was done."""
        self.made += 1
        self.judged += done is not None
        self.right += predicted == done
        self.named += done is not None and predicted.split()[:1] == done.split()[:1]


@dataclass
class Foresight:
    """Everything about predictions in one episode: who expected what, and what came of it."""

    forecasts: list[Forecast] = field(default_factory=list)
    doings: Doings = field(default_factory=Doings)

    def add(self, step: int, robot: str, trace: Mapping[str, Any], of_team: bool) -> None:
        """Take in what one robot reports of a turn (`Turn.trace`)."""
        doing = trace.get("doing")
        if isinstance(doing, Mapping):
            self.doings.tell(step, robot, doing)
        decision = trace.get("decision")
        predictions = decision.get("predictions", ()) if isinstance(decision, Mapping) else ()
        for it in predictions:
            if len(self.forecasts) < MAX_PREDICTIONS:
                self.forecasts.append(
                    Forecast(step, it["teammate"], it["sub_task"], it["sub_skill"], of_team)
                )

    def counts(self, of_team: bool, within: int = WITHIN) -> dict[str, Any]:
        """The field `predictions` of a record: those of the team, or of the newcomer."""
        parts = {part: Accuracy() for part in PARTS}
        for forecast in self.forecasts:
            for part, accuracy in parts.items():
                predicted = getattr(forecast, part)
                if forecast.of_team == of_team and predicted is not None:
                    accuracy.count(
                        predicted, self.doings.next(forecast.teammate, part, forecast.step, within)
                    )
        return {"within": within, **{f"{part}s": asdict(accuracy) for part, accuracy in parts.items()}}
