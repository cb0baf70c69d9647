"""How large the page of an episode is, how long writing it takes, and what looking on costs.

Six robots that plan with a language model (the offline one): a team of five, and an IRoT robot from step
100 on.
They are in a house of ten rooms for 500 steps; so many things are misplaced that nobody runs out of work.
The page shows that episode beside the team alone. Bounds: 3 MB, and 2 s for writing.

    python benchmarks/inspector.py [FILE.html]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hydra import compose, initialize_config_dir
from omegaconf import DictConfig
from rich.console import Console
from rich.table import Table

from adhoc import PyBulletWorld, Ranges, sample_scenario
from adhoc.cli.contestants import Components
from adhoc.cli.schema import register_schema
from adhoc.core.resources import data_dir
from adhoc.dataset.files.dataset_folder import DatasetSplit, found_folder
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.keyed_episode import models_of, run_keyed
from adhoc.evaluation.llm_field import stage_counts
from adhoc.evaluation.recording import make_record
from adhoc.inspecting.film import write_film
from adhoc.inspecting.key_step_figure import draw_key_steps
from adhoc.inspecting.page import packed, page_data, write_page
from adhoc.inspecting.watching import Watched, watch_again

STEPS, MISPLACED, TEAMMATES, JOIN_STEP = 500, 40, 5, 100
RANGES = Ranges(can_manipulate=1.0, max_steps=(STEPS, STEPS), payload=(20.0, 20.0))
MOST_BYTES, MOST_SECONDS = 3_000_000, 2.0
TASK = "test-10-00-k1-t3"
"""Whose house it is: one of ten rooms."""


def main(arguments: list[str]) -> int:
    """Print the table; the exit code says whether the bounds are kept."""
    console = Console(width=100)
    with TemporaryDirectory() as folder:
        page = Path(arguments[0]) if arguments else Path(folder) / "page.html"
        episodes, plain_s, watched_s = _episodes()
        size, page_s = _timed(lambda: write_page(episodes, page))
        alone, _ = _timed(lambda: write_page(episodes[1:], Path(folder) / "one.html"))
        _, figure_s = _timed(lambda: draw_key_steps(episodes, Path(folder), "figure"))
        _, film_s = _timed(lambda: write_film(episodes, Path(folder) / "film.gif"))
    table = Table("what", "measured", "bound", title="the page of 500 steps with six robots")
    table.add_row("both episodes", f"{size / 1e6:.2f} MB", f"{MOST_BYTES / 1e6:.0f} MB")
    table.add_row("the newcomer's episode alone", f"{alone / 1e6:.2f} MB", f"{MOST_BYTES / 1e6:.0f} MB")
    table.add_row("writing the page", f"{page_s:.2f} s", f"{MOST_SECONDS:g} s")
    table.add_row("running the newcomer's episode", f"{plain_s:.1f} s", "-")
    table.add_row("the same, looked at, with pictures", f"{watched_s:.1f} s", "-")
    table.add_row("key steps as PNG and SVG", f"{figure_s:.1f} s", "-")
    table.add_row("a film (GIF)", f"{film_s:.1f} s", "-")
    console.print(table)
    console.print(_contents(episodes))
    return 0 if size <= MOST_BYTES and page_s <= MOST_SECONDS else 1


def _episodes() -> tuple[list[Watched], float, float]:
    """The team alone and with the newcomer, and seconds that the latter took without and with looking."""
    components = Components(_config())
    world = PyBulletWorld()
    house = DatasetSplit(found_folder("paper"), "test").scenario(TASK).house
    scenario = sample_scenario(world, house, 0, MISPLACED, TEAMMATES, RANGES)
    kinds = (
        EpisodeKind(components.conditions),
        EpisodeKind(components.conditions, components.newcomer, JOIN_STEP),
    )
    alone_key, joined_key = (EpisodeKey(scenario, kind) for kind in kinds)
    result, _ = _timed(lambda: run_keyed(world, alone_key))
    alone = make_record(alone_key, result, None, stage_counts(models_of(alone_key)), 0.0)
    result, plain_s = _timed(lambda: run_keyed(world, joined_key, alone))
    joined = make_record(joined_key, result, alone, stage_counts(models_of(joined_key)), 0.0)
    first = watch_again(world, alone_key, alone)
    second, watched_s = _timed(lambda: watch_again(world, joined_key, joined, alone))
    world.close()
    return [first, second], plain_s, watched_s


def _config() -> DictConfig:
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        return compose("run", overrides=["team=llm", "policy=irot", f"max_steps={STEPS}"])


def _contents(episodes: list[Watched]) -> Table:
    """What the newcomer's episode holds, and what takes the room."""
    data = page_data(episodes)
    joined = data["episodes"][1]
    exchanges = [
        exchange
        for _, _, _, trace in joined["decisions"]
        for part in (trace.get("decision") or {}, *trace.get("skills", ()))
        for exchange in part.get("exchanges", ())
    ]
    table = Table("contents of the newcomer's episode", "")
    table.add_row("steps, robots", f"{joined['record']['steps']}, {len(joined['robots'])}")
    table.add_row("decisions, exchanges with the model", f"{len(joined['decisions'])}, {len(exchanges)}")
    table.add_row("messages", str(len(joined["messages"])))
    table.add_row("pictures, left out", f"{len(joined['pictures'])}, {joined['picturesLeftOut']}")
    table.add_row("prompt tokens", f"{joined['llm']['prompt_tokens']:,}")
    for name, part in (("texts", {"lines": data["lines"], "blocks": data["blocks"]}), *_parts(joined)):
        table.add_row(f"{name}, compressed", f"{len(packed(part)) / 1e3:.0f} kB")
    return table


def _parts(episode: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    names = ("robots", "views", "decisions", "messages", "pictures")
    return [(name, {name: episode[name]}) for name in names]


def _timed(work: Any) -> tuple[Any, float]:
    started = time.perf_counter()
    done = work()
    return done, time.perf_counter() - started


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
