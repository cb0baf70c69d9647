"""How fast a robot's loop is: move, sense, map, visible list, scene graph.

Every line is measured in this one run, one process, one core; read the ratios, machines differ. The same loop
runs with the ray-casting sensor and with PyBullet's TinyRenderer, beside TinyRenderer's bare frame.

    python benchmarks/speed.py [HOUSE_FILE ...]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.table import Table

from adhoc import (
    Action,
    ActionName,
    Capability,
    House,
    Perception,
    PyBulletWorld,
    World,
    read_house,
    sample_house,
    stream,
)

ROBOTS = 5
SECONDS = 4.0
WALK = (ActionName.MOVE_AHEAD,) * 5 + (ActionName.ROTATE_LEFT, ActionName.ROTATE_RIGHT, ActionName.MOVE_LEFT)


def main() -> None:
    """Print one table."""
    table = Table(title=f"Agent-steps per second on one core, {ROBOTS} robots", title_justify="left")
    for column in ("house", "pixels", "ray caster", "TinyRenderer", "ratio", "bare TinyRenderer frame"):
        table.add_column(column, justify="right" if column != "house" else "left")
    for house in houses(sys.argv[1:]):
        for size in (128, 64):
            fast, slow = (loop_rate(house, size, renderer) for renderer in ("numba", "tiny"))
            frame = bare_frame_rate(house, size)
            table.add_row(
                f"{house.id} ({len(house.rooms)} rooms)",
                str(size),
                f"{fast:,.0f}/s",
                f"{slow:,.0f}/s",
                f"{fast / slow:.1f}x",
                f"{frame:,.0f}/s",
            )
    Console(width=120).print(table)


def houses(files: list[str]) -> list[House]:
    """The shipped house of one room, and the house files that were named or the largest shipped one."""
    large = [read_house(Path(name)) for name in files] or [sample_house("eight_rooms")]
    return [sample_house("one_room"), *large]


def loop_rate(house: House, size: int, renderer: str) -> float:
    """Agent-steps per second of the whole loop."""
    world = PyBulletWorld(image_size=size, renderer=renderer)
    world.reset(house, seed=0)
    robots = {f"robot_{i}": pose for i, pose in enumerate(world.free_poses(ROBOTS, seed=0))}
    random = stream(0, "bench")
    minds = {name: Perception() for name in robots}
    for i, (name, pose) in enumerate(robots.items()):
        world.add_agent(name, Capability(camera_height=(0.9, 1.6)[i % 2], max_steps=10**9), pose)

    def step() -> None:
        actions = {name: Action(WALK[int(random.integers(len(WALK)))]) for name in robots}
        for name, observation in world.step(actions).items():
            minds[name].observe(observation)
            _ = minds[name].graph

    rate = ROBOTS * rate_of(step)
    world.close()
    return rate


def bare_frame_rate(house: House, size: int) -> float:
    """TinyRenderer frames per second from one robot's camera, nothing else."""
    world: World = PyBulletWorld(image_size=size, renderer="tiny")
    world.reset(house, seed=0)
    (pose,) = world.free_poses(1, seed=0)
    world.add_agent("robot", Capability(), pose)
    rate = rate_of(lambda: world.observe("robot"))
    world.close()
    return rate


def rate_of(step: Callable[[], object]) -> float:
    """Calls per second, after a warm-up that compiles what is compiled at first use."""
    for _ in range(3):
        step()
    calls, start = 0, time.perf_counter()
    while time.perf_counter() - start < SECONDS:
        step()
        calls += 1
    return calls / (time.perf_counter() - start)


if __name__ == "__main__":
    main()
