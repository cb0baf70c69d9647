"""How long a whole episode takes, planning included, and whether its steps get slower as it goes on.

Five robots (a heuristic team of four, and an IRoT robot with the offline model) tidy a house in which so many
things are misplaced that nobody runs out of work in 500 steps. One process, one core.

    python benchmarks/episode.py [HOUSE_FILE]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from statistics import median

from rich.console import Console
from rich.table import Table

from adhoc import (
    CountingModel,
    HeuristicPolicy,
    LLMAgent,
    LLMEvaluator,
    LLMGenerator,
    LLMReflector,
    LLMSubSkillPlanner,
    OfflineReasoner,
    PyBulletWorld,
    Ranges,
    StagedPlanner,
    TidyingUp,
    placement_table,
    read_house,
    run_episode,
    sample_house,
    sample_scenario,
)

MISPLACED = 60
RANGES = Ranges(can_manipulate=1.0, max_steps=(500, 500), payload=(20.0, 20.0))


class StopWatch(PyBulletWorld):
    """A world that notes when each step ended, and how many model calls had been made by then."""

    model: CountingModel
    ends: list[float]
    calls: list[int]

    def step(self, actions):
        """See `World`."""
        observations = super().step(actions)
        self.ends.append(time.perf_counter())
        self.calls.append(self.model.total.calls)
        return observations

    def window(self, first: int, last: int) -> str:
        """Median milliseconds of the steps after `first` up to `last`, all and without model calls."""
        if len(self.ends) < last:
            return "-"
        pairs = [
            (self.ends[i] - self.ends[i - 1], self.calls[i] - self.calls[i - 1]) for i in range(first, last)
        ]
        quiet = [seconds for seconds, calls in pairs if calls == 0]
        calls = sum(calls for _, calls in pairs)
        return f"{median(quiet) * 1000:.1f} ms; {sum(it for it, _ in pairs):.2f} s, {calls} calls"


def main() -> None:
    """Run one episode twice, the first time to compile, and print one table."""
    house = read_house(Path(sys.argv[1])) if len(sys.argv) > 1 else sample_house("eight_rooms")
    world, task = StopWatch(), TidyingUp()
    count = min(MISPLACED, sum(thing.pickupable for thing in house.objects) // 2)
    scenario = sample_scenario(world, house, 0, count, 4, RANGES)
    for _ in range(2):
        model = CountingModel(OfflineReasoner(placement_table()))
        planner = StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model), task.legal)
        newcomer = LLMAgent(planner, LLMSubSkillPlanner(model))
        world.model, world.ends, world.calls = model, [], []
        start = time.perf_counter()
        result = run_episode(world, scenario, task, [HeuristicPolicy() for _ in scenario.team], newcomer)
    rows = {
        "steps, robot-steps": f"{result.steps}, {sum(result.agent_steps.values())}",
        "re-placed": f"{len(result.replaced)} of {count}",
        "model calls (offline, not a language model)": str(model.total.calls),
        "set-up": f"{world.ends[0] - start:.1f} s",
        "episode, planning included": f"{world.ends[-1] - world.ends[0]:.1f} s",
        "steps 1-100: median of steps without a call; all": world.window(1, 100),
        "steps 401-500: median of steps without a call; all": world.window(400, 500),
    }
    title = f"One episode in {house.id}: {len(house.rooms)} rooms, five robots, one core"
    table = Table(title=title, title_justify="left", show_header=False)
    for name, value in rows.items():
        table.add_row(name, value)
    Console(width=120).print(table)
    world.close()


if __name__ == "__main__":
    main()
