"""How long a house takes to generate and a task to load, in one run on this machine.

    python benchmarks/dataset.py [HOUSES]

Generation includes rejected attempts and all checks but gravity, whose time is given beside it. A task is
loaded from the shipped files in a fresh process (cold, without imports) and again among others (warm).
"""

from __future__ import annotations

import subprocess
import sys
import time
from statistics import median

from rich.console import Console

from adhoc.core.streams import derive_seed
from adhoc.dataset.benchmarks import TaskFileBenchmark
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.generator import generate_house
from adhoc.worlds.pybullet_world import PyBulletWorld

ROOMS = (1, 4, 7, 10)
COLD = """
import time
from adhoc.dataset.benchmarks import TaskFileBenchmark
from adhoc.worlds.pybullet_world import PyBulletWorld
world = PyBulletWorld()
started = time.perf_counter()
tasks = TaskFileBenchmark("paper").scenarios(world, 0)
opened = time.perf_counter()
tasks[{position}]
print(opened - started, time.perf_counter() - opened)
"""


def main(houses: int) -> None:
    """Print both parts."""
    say = Console(width=100, highlight=False).print
    generate_house(10, 0)  # compiles
    say(f"generation, medians of {houses} houses (slowest in brackets)")
    for rooms in ROOMS:
        times, falls = zip(*(generation_times(rooms, index) for index in range(houses)))
        share = median(times) / median(falls)
        say(
            f"  {rooms:2} rooms: {1000 * median(times):6.1f} ms ({1000 * max(times):.0f}) with all checks "
            f"but gravity, which takes {1000 * median(falls):.0f} ms more: ratio {share:.2f}"
        )
    say("loading one task of ten rooms")
    opened, cold = map(float, run_cold(1200).split())
    say(f"  cold: {1000 * cold:.1f} ms, after {1000 * opened:.0f} ms of opening the benchmark")
    warm = warm_times(range(1200, 1350, 5))
    say(f"  warm: {1000 * median(warm):.1f} ms ({1000 * max(warm):.1f})")


def generation_times(rooms: int, index: int) -> tuple[float, float]:
    """Seconds to generate one house, and to let everything in it fall."""
    started = time.perf_counter()
    house = generate_house(rooms, derive_seed(0, "bench", rooms, index)).house
    generated = time.perf_counter()
    check_gravity(house)
    return generated - started, time.perf_counter() - generated


def run_cold(position: int) -> str:
    """Seconds to open the benchmark and to load one task, in a process of its own."""
    command = [sys.executable, "-c", COLD.format(position=position)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1]


def warm_times(positions: range) -> list[float]:
    """Seconds to load each of some tasks."""
    tasks = TaskFileBenchmark("paper").scenarios(PyBulletWorld(), 0)
    tasks[0]
    times = []
    for position in positions:
        started = time.perf_counter()
        tasks[position]
        times.append(time.perf_counter() - started)
    return times


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
