"""An episode as a recording for the Rerun viewer, with the extra `adhoc[rerun]`."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from adhoc.core.errors import MissingDependency
from adhoc.core.values import Pose
from adhoc.evaluation.floor_shapes import OTHER_ROOM, ROOM_COLOURS, WALL, footprint, hangs
from adhoc.evaluation.palette import MISPLACED, REPLACED, robot_colour
from adhoc.evaluation.records import writing
from adhoc.houses.house import House
from adhoc.inspecting.field_of_view import RAYS, unit_of
from adhoc.inspecting.moment_drawing import placed_at
from adhoc.inspecting.watching import Watched

TIME = "step"
NEWCOMER = "#f2f2f2"
"""White, on the viewer's dark ground."""
_EXTRA = "pip install 'adhoc[rerun]'"


def load_rerun() -> Any:
    """The package `rerun`. Raises MissingDependency if it is not installed, or another of that name is."""
    try:
        rerun = import_module("rerun")
    except ImportError as error:
        raise MissingDependency(f".rrd needs the package rerun-sdk: {_EXTRA}") from error
    if not hasattr(rerun, "RecordingStream"):
        raise MissingDependency(
            f".rrd needs the package rerun-sdk; the installed 'rerun' is another: {_EXTRA}"
        )
    return rerun


def write_rerun(watched: Watched, path: Path) -> None:
    """Write an episode into a `.rrd` file: house, robots, fields of view, paths, objects, messages, decisions
    and their pictures over the time line `step`, the axes of the world in metres.

    Overwrites the file. Raises MissingDependency without rerun-sdk, RecordError if it cannot be written.
    """
    rerun = load_rerun()
    with writing(path):
        path.unlink(missing_ok=True)
        stream = rerun.RecordingStream(
            "adhoc", recording_id=str(watched.record["episode_id"]), send_properties=False
        )
        stream.set_log_time_enabled(False)
        stream.set_log_tick_enabled(False)
        stream.save(path)
        _log_house(rerun, stream, watched.result.scenario.house)
        _log_about(rerun, stream, watched)
        for step in range(watched.result.steps + 1):
            stream.set_time(TIME, sequence=step)
            _log_robots(rerun, stream, watched, step)
            _log_objects(rerun, stream, watched, step)
        _log_messages(rerun, stream, watched)
        _log_decisions(rerun, stream, watched)
        stream.flush()
        stream.disconnect()


def _log_about(rerun: Any, stream: Any, watched: Watched) -> None:
    record = watched.record
    model = record["model"] or "none"
    text = (
        f"# {record['episode_id']}\n\nLanguage model: **{_plain(model)}**\n\n{_plain(record['ending'])} "
        f"after {record['steps']} steps, {record['replaced']} of {record['misplaced']} re-placed"
    )
    stream.log("about", rerun.TextDocument(text, media_type="text/markdown"), static=True)


def _log_house(rerun: Any, stream: Any, house: House) -> None:
    rooms = [[*room.polygon, room.polygon[0]] for room in house.rooms]
    stream.log(
        "house/rooms",
        rerun.LineStrips3D(
            [_level(corners) for corners in rooms],
            colors=[_rgb(ROOM_COLOURS.get(room.room_type, OTHER_ROOM)) for room in house.rooms],
            labels=[room.room_type for room in house.rooms],
        ),
        static=True,
    )
    walls = [_level((wall.start, wall.end)) for wall in house.walls]
    stream.log("house/walls", rerun.LineStrips3D(walls, colors=_rgb(WALL), radii=0.04), static=True)
    things = [thing for thing in house.objects if not thing.pickupable and not hangs(thing)]
    outlines = [footprint(thing) for thing in things]
    stream.log(
        "house/furniture",
        rerun.LineStrips3D(
            [_level([*corners, corners[0]], thing.size[2]) for corners, thing in zip(outlines, things)],
            colors=(150, 145, 135),
        ),
        static=True,
    )


def _log_robots(rerun: Any, stream: Any, watched: Watched, step: int) -> None:
    recording = watched.recording
    for position, (name, track) in enumerate(recording.tracks.items()):
        at = step - track.first
        path = f"robots/{_entity(name)}"
        if not 0 <= at < len(track.poses):
            if at == len(track.poses):
                stream.log(path, rerun.Clear(recursive=True))
            continue
        is_newcomer = name == watched.result.scenario.newcomer.name
        colour = _rgb(NEWCOMER if is_newcomer else robot_colour(position))
        pose = track.poses[at]
        stream.log(
            path,
            rerun.Arrows3D(
                origins=[(pose.x, pose.y, 0.1)],
                vectors=[_ahead(pose)],
                colors=colour,
                radii=0.06,
                labels=[name],
            ),
        )
        walked = [(it.x, it.y) for it in track.poses[: at + 1]]
        if len(walked) > 1 and track.poses[at] != track.poses[at - 1]:
            stream.log(f"{path}/path", rerun.LineStrips3D([_level(walked, 0.02)], colors=colour, radii=0.02))
        view = track.views[at]
        if view >= 0:
            seen = _outline(recording.views[view], unit_of(recording.reach), pose)
            stream.log(f"{path}/view", rerun.LineStrips3D([_level(seen, 0.02)], colors=colour, radii=0.01))


def _log_objects(rerun: Any, stream: Any, watched: Watched, step: int) -> None:
    recording = watched.recording
    moved = {move.object.id: move.object for move in recording.moves if move.step == step}
    if step and not moved:
        return
    places = dict(recording.objects)
    for move in recording.moves:
        if move.step <= step:
            places[move.object.id] = move.object
    placed = placed_at(watched, step)
    named = [places[name] for name in watched.result.watched if name in places]
    stream.log(
        "objects/misplaced",
        rerun.Points3D(
            [truth.position for truth in named],
            colors=[_rgb(REPLACED if truth.id in placed else MISPLACED) for truth in named],
            labels=[truth.id for truth in named],
            radii=0.1,
        ),
    )


def _log_messages(rerun: Any, stream: Any, watched: Watched) -> None:
    for message in watched.result.trace.messages:
        if message.kind.value != "team":
            stream.set_time(TIME, sequence=message.step)
            text = f"{message.sender} ({message.kind.value}): {message.text}"
            stream.log("messages", rerun.TextLog(text, level=rerun.TextLogLevel.INFO))


def _log_decisions(rerun: Any, stream: Any, watched: Watched) -> None:
    for decision in watched.recording.decisions:
        stream.set_time(TIME, sequence=decision.step)
        path = f"decisions/{_entity(decision.robot)}"
        text = json.dumps(_without_prompts(decision.trace), indent=1, default=str)
        stream.log(f"{path}/trace", rerun.TextDocument(text, media_type="text/plain"))
        if decision.picture is not None:
            picture = watched.recording.pictures[decision.picture]
            stream.log(f"{path}/picture", rerun.EncodedImage(contents=picture, media_type="image/jpeg"))


def _without_prompts(value: Any) -> Any:
    """A trace without its exchanges, which would make the file a hundred times larger; pages have them."""
    if isinstance(value, Mapping):
        return {name: _without_prompts(inner) for name, inner in value.items() if name != "exchanges"}
    if isinstance(value, (list, tuple)):
        return [_without_prompts(inner) for inner in value]
    return value


def _outline(view: bytes, unit: float, pose: Pose) -> list[tuple[float, float]]:
    numbers = [byte - 256 if byte > 127 else byte for byte in view]
    points = [(numbers[2 * ray] * unit, numbers[2 * ray + 1] * unit) for ray in range(RAYS)]
    here = (pose.x, pose.y)
    return [here, *((pose.x + x, pose.y + y) for x, y in points), here]


def _ahead(pose: Pose) -> tuple[float, float, float]:
    return (0.4 * math.cos(pose.yaw), 0.4 * math.sin(pose.yaw), 0.0)


def _level(points: Any, height: float = 0.0) -> list[tuple[float, float, float]]:
    return [(x, y, height) for x, y in points]


def _rgb(colour: str) -> tuple[int, int, int]:
    return (int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16))


def _entity(name: str) -> str:
    """A robot's name as a part of an entity's path."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)


def _plain(text: object) -> str:
    """Text that brings no markup of its own."""
    return re.sub(r"([\\`*_\[\]<>#|~!])", r"\\\1", str(text))
