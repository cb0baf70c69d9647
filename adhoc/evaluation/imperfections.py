"""What is wrong with a team: its radio, and its robots by the numbers of their seats."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.dialects.structured import Silent
from adhoc.agents.imperfect.imperfect_policy import with_fault
from adhoc.agents.imperfect.mistaken import MistakenPolicy
from adhoc.agents.imperfect.untruthful import UntruthfulPolicy
from adhoc.agents.policy import Policy
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.radio import Radio
from adhoc.evaluation.scenario import Member, Scenario

Rates = Mapping[int, float]
Steps = Mapping[int, int]
GROUP = "imperfections"
"""Their place in a configuration, as errors name it."""
LONGEST_SUMMARY = 60
"""Characters; longer ones are told apart by a hash."""


class Imperfections:
    """The faults of a team (not in the paper, whose robots work and speak without fault); none by default.

    Robots are named by their seats: teammates are numbered from 0 in the order of the scenario. In a scenario
    whose team does not have a seat it is passed over, since teams differ in size (see `check_seats`). The
    newcomer has no faults of its own,
    but its messages go over the same radio. Everything random is drawn from the seed of the scenario and the
    names of the robots concerned.

    Args:
        loss, delay, jitter, range: Of all messages, also private ones; see `Radio`.
        silent: Seats of robots that say nothing to strangers: no reports, no answers, no questions. They
            work, and their own team hears what it says to itself.
        wrong: For each seat, the probability of being wrong about an object; see `MistakenPolicy`.
        untruthful: For each seat, the probability of a lie in a report; see `UntruthfulPolicy`.
        breaks_down: For each seat, the step at which the robot breaks down: from then on it does nothing,
            hears nothing and answers nothing. It stays in the way, with what it holds.
        battery: For each seat, the steps that its battery really lasts, if those are fewer than its
            capability promises. Only its own display (`Observation.steps_left`) tells; the capability that
            it is told, and tells others, is that of a full battery.
        leaves: For each seat, the step at which the robot is taken away. What it holds stays on the floor
            where it stood (`World.remove_agent`).

    Raises:
        ConfigurationError: a value is out of its range. Errors name keys as they are typed.
    """

    def __init__(
        self,
        loss: float = 0.0,
        delay: int = 0,
        jitter: int = 0,
        range: float | None = None,
        silent: Sequence[int] | None = None,
        wrong: Mapping[Any, float] | None = None,
        untruthful: Mapping[Any, float] | None = None,
        breaks_down: Mapping[Any, int] | None = None,
        battery: Mapping[Any, int] | None = None,
        leaves: Mapping[Any, int] | None = None,
    ) -> None:
        try:
            radio = Radio(loss, delay, jitter, range)
        except ConfigurationError as error:
            raise ConfigurationError(f"{GROUP}.{error}") from error
        self.radio = replace(radio, loss=float(loss), range=None if range is None else float(range))
        self.silent = frozenset(_seats(silent, "silent"))
        self.wrong: Rates = _rates(wrong, "wrong")
        self.untruthful: Rates = _rates(untruthful, "untruthful")
        self.breaks_down: Steps = _steps(breaks_down, "breaks_down")
        self.battery: Steps = _steps(battery, "battery")
        self.leaves: Steps = _steps(leaves, "leaves")

    @property
    def settings(self) -> dict[str, Any]:
        """What is wrong, as JSON values; empty if nothing is."""
        perfect = vars(Radio())
        by_seat = self._by_seat
        return {
            **{name: value for name, value in vars(self.radio).items() if value != perfect[name]},
            **({"silent": sorted(self.silent)} if self.silent else {}),
            **{name: {str(seat): it[seat] for seat in sorted(it)} for name, it in by_seat.items() if it},
        }

    @property
    def summary(self) -> str:
        """In a few words, as names of teams in records, tables and files carry it; empty without faults."""
        words = []
        for name, value in self.settings.items():
            told = value if not isinstance(value, Mapping) else [f"{seat}:{it}" for seat, it in value.items()]
            listed = " ".join(map(str, told)) if isinstance(told, list) else str(told)
            words.append(f"{name.replace('_', ' ')} {listed}")
        return shortened(", ".join(words), "imperfect")

    def check_seats(self, most: int) -> None:
        """Check that there can be the robots that are named, in teams of `most` robots at the most.

        Raises ConfigurationError for a seat that no team has.
        """
        given: Mapping[str, tuple[Iterable[int], object]] = {
            "silent": (self.silent, sorted(self.silent)),
            **{name: (it, it) for name, it in self._by_seat.items()},
        }
        for name, (seats, value) in given.items():
            for seat in seats:
                if seat >= most:
                    raise ConfigurationError(
                        f"{_typed(name, value)}: no scenario of the run has a seat {seat}: the largest team "
                        f"has {most} robots, seats 0 to {most - 1}"
                    )

    def check_steps(self, max_steps: int) -> None:
        """Check that episodes of so many steps come to what is to happen in them.

        Raises ConfigurationError for a step that none reaches, and a battery that outlasts all of them.
        """
        for name, it, last in (
            ("breaks_down", self.breaks_down, max_steps - 1),
            ("leaves", self.leaves, max_steps - 1),
            ("battery", self.battery, max_steps),
        ):
            for seat, step in it.items():
                if step > last:
                    raise ConfigurationError(
                        f"{_typed(name, it)}: seat {seat}: with max_steps={max_steps} no episode comes to "
                        f"step {step}; at most {last}"
                    )

    @property
    def _by_seat(self) -> Mapping[str, Mapping[int, float]]:
        return {
            "wrong": self.wrong,
            "untruthful": self.untruthful,
            "breaks_down": self.breaks_down,
            "battery": self.battery,
            "leaves": self.leaves,
        }

    def mind(self, seat: int, policy: Policy) -> Policy:
        """The policy of the robot in that seat, with its faults; itself if it has none."""
        if seat in self.wrong:
            policy = with_fault(policy, partial(MistakenPolicy, rate=self.wrong[seat]))
        if seat in self.untruthful:
            policy = with_fault(policy, partial(UntruthfulPolicy, rate=self.untruthful[seat]))
        return Speaking(policy, Silent()) if seat in self.silent else policy

    def batteries(self, scenario: Scenario) -> Scenario:
        """The scenario with the batteries that there really are."""
        team = tuple(self._with_battery(seat, member) for seat, member in enumerate(scenario.team))
        return scenario if team == scenario.team else replace(scenario, team=team)

    def _with_battery(self, seat: int, member: Member) -> Member:
        promised = member.capability.max_steps
        lasting = min(self.battery.get(seat, promised), promised)
        return replace(member, capability=replace(member.capability, max_steps=lasting))


def _rates(given: object, field: str) -> dict[int, float]:
    rates = _by_seat(given, field)
    for seat, rate in rates.items():
        if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not 0.0 <= rate <= 1.0:
            raise ConfigurationError(
                f"{_typed(field, given)}: seat {seat}: {rate!r} must be a probability, 0 to 1"
            )
    return {seat: float(rate) for seat, rate in rates.items()}


def _steps(given: object, field: str) -> dict[int, int]:
    steps = _by_seat(given, field)
    for seat, step in steps.items():
        if isinstance(step, bool) or not isinstance(step, int) or step < 0:
            raise ConfigurationError(
                f"{_typed(field, given)}: seat {seat}: {step!r} must be a number of steps, at least 0"
            )
    return steps


def _by_seat(given: object, field: str) -> dict[int, Any]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ConfigurationError(f"{_typed(field, given)}: must have a value for each seat, e.g. {{0:100}}")
    seats = _seats(list(given), field, given)
    return dict(zip(seats, given.values()))


def _seats(given: object, field: str, typed: object = None) -> list[int]:
    """Numbers of seats, which a configuration may write as texts; `typed` is the value that names them."""
    typed = given if typed is None else typed
    if given is None:
        return []
    if not isinstance(given, (list, tuple)):
        raise ConfigurationError(f"{_typed(field, typed)}: must be a list of seats, e.g. [0,2]")
    if not all(str(seat).isdecimal() for seat in given):
        raise ConfigurationError(f"{_typed(field, typed)}: seats are numbers, 0 for the first teammate")
    seats = [int(str(seat)) for seat in given]
    if len(set(seats)) != len(seats):
        raise ConfigurationError(f"{_typed(field, typed)}: names a seat twice")
    return seats


def _typed(field: str, value: object) -> str:
    """A setting as it is typed on the command line."""
    if isinstance(value, Mapping):
        text = "{" + ",".join(f"{seat}:{it}" for seat, it in value.items()) + "}"
    elif isinstance(value, (list, tuple)):
        text = "[" + ",".join(map(str, value)) + "]"
    else:
        text = str(value)
    return f"{GROUP}.{field}={text}"


def shortened(text: str, word: str) -> str:
    """A summary that is fit for names: as it is, or a word and a hash if it is long."""
    if len(text) <= LONGEST_SUMMARY:
        return text
    return f"{word} {hashlib.sha256(text.encode()).hexdigest()[:8]}"


PERFECT = Imperfections()
"""Nothing is wrong: the paper's teams."""
