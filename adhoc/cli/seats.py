"""Mixed teams: other policies for some of a team's robots, by the numbers of their seats."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from adhoc.cli.build import TARGET
from adhoc.core.errors import ConfigurationError

SEATS = "seats"
"""The key of a team's configuration that holds the configurations of single teammates."""


def numbered_seats(config: Mapping[str, Any], group: str) -> dict[str, Any]:
    """A policy's configuration, with the seats' numbers as JSON writes them; as it was if it names none.

    Seats are numbered from 0 in the order of a scenario's team. One that a team does not have is not
    filled: teams differ in size (see `check_seats`). Raises ConfigurationError for what is no number of a
    seat.
    """
    seats = config.get(SEATS)
    others = {name: value for name, value in config.items() if name != SEATS}
    if not seats:
        return others
    if not isinstance(seats, Mapping) or not all(isinstance(seat, Mapping) for seat in seats.values()):
        raise ConfigurationError(
            f"{group}.{SEATS}={seats!r}: must give a policy for each seat, e.g. {{1: {{agent: ...}}}}"
        )
    numbered = {str(_number(seat, group)): seated for seat, seated in seats.items()}
    if len(numbered) < len(seats):
        raise ConfigurationError(f"{group}.{SEATS}: names a seat twice: {', '.join(map(repr, seats))}")
    return {**others, SEATS: numbered}


def at_seat(config: Mapping[str, Any], group: str, seat: int) -> tuple[str, Mapping[str, Any]]:
    """Where the policy of a seat is described, and its description there.

    `config` is as `numbered_seats` returns it. A seat's description is whole: nothing of the others' is
    taken over.
    """
    seated = config.get(SEATS, {}).get(str(seat))
    return (group, config) if seated is None else (f"{group}.{SEATS}.{seat}", seated)


def check_seats(config: Mapping[str, Any], group: str, most: int) -> None:
    """Raises ConfigurationError for a seat that no team has, if the largest has `most` robots."""
    for seat, seated in config.get(SEATS, {}).items():
        if int(seat) >= most:
            agent = seated.get("agent")
            what = seated.get("name") or (agent.get(TARGET) if isinstance(agent, Mapping) else agent)
            raise ConfigurationError(
                f"{group}.{SEATS}.{seat}={what}: no scenario of the run has a seat {seat}: the largest team "
                f"has {most} robots, seats 0 to {most - 1}"
            )


def _number(seat: object, group: str) -> int:
    text = str(seat)
    if not text.isdecimal():
        raise ConfigurationError(f"{group}.{SEATS}.{text}: seats are numbers, 0 for the first teammate")
    return int(text)
