"""Houses and scenarios to learn from: drawn from seeds of their own, never those of a benchmark."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.streams import derive_seed
from adhoc.dataset.generator import ROOM_COUNTS, generate_house
from adhoc.dataset.making.findable import Findable
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.worlds.world import World

FIT, CHOOSE, VALIDATE = "fit", "choose", "validate"
"""What houses are for: examples to fit to; to choose the best epoch by; to report accuracies on. No house is
in two of them."""

_PURPOSE = "training house"
"""Names the random streams of these houses. Those of datasets are named `house`, so that no seed gives a
house of a dataset (see `dataset.making.house_making`)."""


@dataclass(frozen=True)
class HouseDraw:
    """One house, by what decides it; plain, so that it can be sent to another process."""

    split: str
    index: int
    seed: int
    """The seed of the whole training."""

    @property
    def rooms(self) -> int:
        """The numbers of rooms take turns."""
        return ROOM_COUNTS[self.index % len(ROOM_COUNTS)]

    @property
    def house_id(self) -> str:
        """E.g. `fit-0013`."""
        return f"{self.split}-{self.index:04d}"

    def derive(self, *names: str | int) -> int:
        """A seed of this house's own."""
        return derive_seed(self.seed, _PURPOSE, self.split, self.rooms, self.index, *names)


def house_draws(split: str, count: int, seed: int) -> list[HouseDraw]:
    """The first `count` houses of a split; a larger count begins with the same houses."""
    return [HouseDraw(split, index, seed) for index in range(count)]


def house_of(draw: HouseDraw) -> House:
    """The house itself, furnished and with everything in its usual place."""
    return generate_house(draw.rooms, draw.derive(), draw.house_id).house


def scenarios_of(world: World, draw: HouseDraw, count: int) -> Iterator[Scenario]:
    """Up to `count` tasks in the house, drawn as the benchmark's are; one that finds no room is left out."""
    house = house_of(draw)
    for number in range(count):
        name = f"{draw.house_id}-{number}"
        with suppress(WorldError, ConfigurationError):
            yield sample_scenario(
                world, house, draw.derive("scenario", number), name=name, accepting=Findable
            )
