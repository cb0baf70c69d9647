"""An episode as a film from above: GIF with what is always there, MP4 with an extra package."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.evaluation.floor_drawing import draw_house
from adhoc.evaluation.floor_shapes import FURNITURE_FACE, OTHER_ROOM, ROOM_COLOURS
from adhoc.evaluation.palette import MISPLACED, NEWCOMER, OUTLINE, REPLACED, ROBOTS
from adhoc.evaluation.records import writing
from adhoc.inspecting.moment_drawing import (
    NEWCOMER_VIEW_ALPHA,
    VIEW_ALPHA,
    draw_objects,
    draw_paths,
    draw_robots,
    draw_views,
    placed_at,
)
from adhoc.inspecting.titles import titles
from adhoc.inspecting.watching import Watched

MOST_FRAMES = 250
"""Of a film; of longer episodes some steps are left out."""
SPEED = 10
"""Frames a second."""
DPI = 80
WIDTH = 5.4
"""Inches of one episode."""
TITLE = 0.62
TALLEST = 6.0
LAST_FRAMES = 15
"""How often the last frame is repeated, so that one sees how it ended."""
_BACKDROP_COLOURS = 160
"""Of the 256 that a GIF has."""
_EXTRA = "pip install 'adhoc[viz]'"


def check_film(path: Path) -> None:
    """Raise MissingDependency if there is nothing to write such a film with, ConfigurationError if it is
    neither GIF nor MP4."""
    kind = path.suffix.lower()
    if kind not in (".gif", ".mp4"):
        raise ConfigurationError(f"{path}: a film must end with .gif or .mp4")
    if kind == ".mp4" and (find_spec("imageio") is None or find_spec("imageio_ffmpeg") is None):
        raise MissingDependency(
            f"{path}: MP4 needs the packages imageio and imageio-ffmpeg: {_EXTRA}; a GIF needs none"
        )


def write_film(episodes: Sequence[Watched], path: Path) -> int:
    """Draw episodes side by side, step by step, into a GIF or MP4 file; returns the number of frames.

    Overwrites the file. Raises what `check_film` raises, and RecordError if the file cannot be written.
    """
    check_film(path)
    frames = film_frames(episodes)
    with writing(path):
        return _write_gif(frames, path) if path.suffix.lower() == ".gif" else _write_mp4(frames, path)


def film_frames(episodes: Sequence[Watched]) -> Iterator[NDArray[np.uint8]]:
    """The pictures of a film, (H, W, 3), with even numbers of pixels, as MP4 wants them.

    What never moves is drawn once.
    """
    figure = Figure(dpi=DPI, facecolor="white")
    canvas: Any = FigureCanvasAgg(figure)
    panels = _lay_out(figure, episodes)
    canvas.draw()
    backdrop = canvas.copy_from_bbox(figure.bbox)
    last = max(watched.result.steps for watched in episodes)
    stride = max(1, -(-(last + 1) // MOST_FRAMES))
    for step in [*range(0, last, stride), *[last] * LAST_FRAMES]:
        canvas.restore_region(backdrop)
        for axes, watched in panels:
            _draw_moment(axes, watched, min(step, watched.result.steps))
        yield np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[:, :, :3])


def _lay_out(figure: Figure, episodes: Sequence[Watched]) -> list[tuple[Axes, Watched]]:
    house = episodes[0].result.scenario.house
    probe = figure.add_axes((0, 0, 1, 1))
    draw_house(probe, house)
    (left, right), (low, high) = probe.get_xlim(), probe.get_ylim()
    probe.remove()
    plan = min(TALLEST, WIDTH * (high - low) / (right - left))
    height, width = plan + TITLE, WIDTH * len(episodes)
    figure.set_size_inches(_even(width), _even(height))
    panels = []
    named = titles([watched.record for watched in episodes])
    for number, (watched, who) in enumerate(zip(episodes, named)):
        axes = figure.add_axes((number / len(episodes), 0.0, 1 / len(episodes), plan / height))
        draw_house(axes, house, 0.7, furniture_names=False)
        record = watched.record
        model = record["model"] or "none"
        figure.text(
            (number + 0.02) / len(episodes),
            1 - 0.2 / height,
            f"{record['task_id']}, {record['team_label']} team: {who}",
            fontsize=8.5,
            fontweight="bold",
            color=OUTLINE,
            va="center",
        )
        figure.text(
            (number + 0.02) / len(episodes),
            1 - 0.44 / height,
            f"language model: {model}",
            fontsize=7.5,
            va="center",
        )
        panels.append((axes, watched))
    return panels


def _draw_moment(axes: Axes, watched: Watched, step: int) -> None:
    artists = [
        *draw_paths(axes, watched, 0, step, in_colour=True, size=0.8),
        *draw_views(axes, watched, step),
        *draw_objects(axes, watched, step),
        *draw_robots(axes, watched, step),
    ]
    ended = f": {watched.result.ending.value}" if step == watched.result.steps else ""
    count = f"{len(placed_at(watched, step))}/{len(watched.result.watched)}"
    artists.append(
        axes.text(
            0.98,
            1.01,
            f"step {step}, {count} re-placed{ended}",
            transform=axes.transAxes,
            fontsize=7.5,
            ha="right",
            va="bottom",
        )
    )
    for artist in sorted(artists, key=lambda it: it.get_zorder()):
        axes.draw_artist(artist)
        artist.remove()


def _even(inches: float) -> float:
    """The nearest length that is an even number of pixels."""
    return 2 * round(inches * DPI / 2) / DPI


def _write_gif(frames: Iterator[NDArray[np.uint8]], path: Path) -> int:
    from PIL import Image

    first = Image.fromarray(next(frames))
    backdrop = first.quantize(_BACKDROP_COLOURS, dither=Image.Dither.NONE).getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([*backdrop[: 3 * _BACKDROP_COLOURS], *_moving_colours()])
    start, *others = (
        picture.quantize(palette=palette, dither=Image.Dither.NONE)
        for picture in chain([first], map(Image.fromarray, frames))
    )
    duration = 1000 // SPEED
    start.save(path, "GIF", save_all=True, append_images=others, duration=duration, loop=0, optimize=False)
    return 1 + len(others)


def _moving_colours() -> list[int]:
    """Red, green and blue of whatever moves, which the first frame may hardly show: robots, marks, and fields
    of view on every floor."""
    solid = [to_rgb(name) for name in (*ROBOTS, NEWCOMER, OUTLINE, MISPLACED, REPLACED)]
    floors = [to_rgb(name) for name in (*ROOM_COLOURS.values(), OTHER_ROOM, FURNITURE_FACE)]
    seen = [(to_rgb(name), VIEW_ALPHA) for name in ROBOTS] + [(to_rgb(NEWCOMER), NEWCOMER_VIEW_ALPHA)]
    mixed = [
        tuple(alpha * above + (1 - alpha) * below for above, below in zip(colour, floor))
        for colour, alpha in seen
        for floor in floors
    ]
    return [round(255 * channel) for colour in (*solid, *mixed) for channel in colour]


def _write_mp4(frames: Iterator[NDArray[np.uint8]], path: Path) -> int:
    writer: Any = import_module("imageio").get_writer(path, format="FFMPEG", fps=SPEED, macro_block_size=2)
    count = 0
    try:
        for frame in frames:
            writer.append_data(frame)
            count += 1
    finally:
        writer.close()
    return count
