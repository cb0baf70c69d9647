"""A watched episode as plain values, for a page."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.core.values import Capability
from adhoc.evaluation.scenario import Member
from adhoc.inspecting.field_of_view import RAYS, unit_of
from adhoc.inspecting.recorder import RecordedDecision, Recording, Track
from adhoc.inspecting.snapshots import within
from adhoc.inspecting.texts import TextStore
from adhoc.inspecting.watching import Watched

PICTURE_BYTES = 600_000
"""What the pictures of one episode may take."""
DEEPEST = 12
"""Levels of a reported trace that are shown."""
_TOLD = (
    "episode_id",
    "task_id",
    "difficulty",
    "team",
    "team_label",
    "policy",
    "policy_label",
    "join_step",
    "joined",
    "joined_elsewhere",
    "seed",
    "model",
    "team_model",
    "max_steps",
    "steps",
    "ending",
    "success",
    "replaced",
    "misplaced",
    "partial_success",
    "action_steps",
    "messages",
    "history_hash",
    "config_hash",
    "library_version",
    "run",
)
"""Fields of a record that a page shows."""


def episode_data(watched: Watched, texts: TextStore) -> dict[str, Any]:
    """Everything that a page shows of one episode; texts go to the store.

    Robots and objects are told by their numbers in `robots` and `objects`; places are in centimetres, angles
    in degrees. Keys of one letter are explained where they are read, in `page/model.js`.
    """
    record, result, recording = watched.record, watched.result, watched.recording
    robots = {name: number for number, name in enumerate(recording.tracks)}
    objects = {name: number for number, name in enumerate(recording.objects)}
    members = {member.name: member for member in (*result.scenario.team, result.scenario.newcomer)}
    llm = record["llm"]
    return {
        "record": {field: record.get(field) for field in _TOLD},
        "llm": {
            name: llm.get(name, 0) for name in ("calls", "prompt_tokens", "completion_tokens", "cost_usd")
        },
        "robots": [
            _robot(name, track, recording, objects, members.get(name), texts)
            for name, track in recording.tracks.items()
        ],
        "newcomer": robots.get(result.scenario.newcomer.name, -1),
        "views": {
            "rays": RAYS,
            "unit": unit_of(recording.reach),
            "points": base64.b64encode(b"".join(recording.views)).decode(),
        },
        "grid": [
            recording.grid.x,
            recording.grid.y,
            recording.grid.cell,
            recording.grid.columns,
            recording.grid.rows,
        ],
        "objects": [
            {
                "id": it.id,
                "name": it.category,
                "x": _centimetres(it.position[0]),
                "y": _centimetres(it.position[1]),
            }
            for it in recording.objects.values()
        ],
        "moves": [
            [
                move.step,
                objects[move.object.id],
                _centimetres(move.object.position[0]),
                _centimetres(move.object.position[1]),
                -1 if move.object.holder is None else robots.get(move.object.holder, -1),
                texts.line(move.object.receptacle or ""),
            ]
            for move in recording.moves
            if move.object.id in objects
        ],
        "events": [
            [event.step, robots.get(event.agent, -1), event.kind, objects.get(event.object_id or "", -1)]
            for event in result.trace.events
        ],
        "messages": [
            [
                message.step,
                robots.get(message.sender, -1),
                -1 if message.recipient is None else robots.get(message.recipient, -1),
                message.kind.value,
                texts.line(message.text),
            ]
            for message in result.trace.messages
        ],
        **_decisions(recording, robots, texts),
        "leftOut": {"decisions": recording.left_out, "messages": result.trace.dropped},
    }


def _robot(
    name: str,
    track: Track,
    recording: Recording,
    objects: Mapping[str, int],
    member: Member | None,
    texts: TextStore,
) -> dict[str, Any]:
    return {
        "name": name,
        "able": None if member is None else _capability(member.capability),
        "first": track.first,
        "x": _steps([_centimetres(pose.x) for pose in track.poses]),
        "y": _steps([_centimetres(pose.y) for pose in track.poses]),
        "yaw": _steps([round(math.degrees(pose.yaw)) for pose in track.poses]),
        "pitch": _steps([round(math.degrees(pose.pitch)) for pose in track.poses]),
        "view": _steps(track.views),
        "held": _steps([-1 if held is None else objects.get(held, -1) for held in track.held]),
        "actions": [texts.line(action) for action in track.actions],
        "doing": [
            [step, texts.line(sub_task or ""), texts.line(sub_skill or "")]
            for step, sub_task, sub_skill in recording.doings.get(name, ())
        ],
        "floor": [list(entry) for entry in recording.floors[name].entries]
        if name in recording.floors
        else None,
    }


def _capability(capability: Capability) -> dict[str, Any]:
    return {
        "manipulates": capability.can_manipulate,
        "height": capability.camera_height,
        "payload": capability.payload,
        "battery": capability.max_steps,
    }


def _decisions(recording: Recording, robots: Mapping[str, int], texts: TextStore) -> dict[str, Any]:
    pictured = [it for it in recording.decisions if it.picture is not None]
    wanted = [it.picture for it in pictured if it.is_sub_task and it.picture is not None]
    kept = within(recording.pictures, wanted, PICTURE_BYTES)
    places = {number: place for place, number in enumerate(kept)}
    return {
        "decisions": [
            [
                it.step,
                robots.get(it.robot, -1),
                places.get(-1 if it.picture is None else it.picture, -1),
                _trace(it, texts),
            ]
            for it in recording.decisions
        ],
        "pictures": [base64.b64encode(picture).decode() for picture in kept.values()],
        "picturesLeftOut": len(recording.pictures) - len(kept),
    }


def _trace(decision: RecordedDecision, texts: TextStore) -> Any:
    return _plain(decision.trace, texts, 0)


def _plain(value: Any, texts: TextStore, depth: int) -> Any:
    """JSON values of whatever a policy reported; prompts and replies go to the store."""
    if value is None or isinstance(value, (bool, int)):
        return value
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    if isinstance(value, str) or depth > DEEPEST:
        return texts.clipped(str(value))
    if isinstance(value, Mapping):
        return {
            str(name): _exchanges(inner, texts) if name == "exchanges" else _plain(inner, texts, depth + 1)
            for name, inner in value.items()
        }
    if isinstance(value, Sequence):
        return [_plain(inner, texts, depth + 1) for inner in value]
    return texts.clipped(str(value))


def _exchanges(value: Any, texts: TextStore) -> list[dict[str, Any]]:
    """Of each call of a model: stage, prompt (role and block), reply (a block), model, tokens, and cost."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return []
    return [
        {
            **{
                name: _plain(inner, texts, DEEPEST)
                for name, inner in one.items()
                if name not in ("prompt", "reply")
            },
            "prompt": [
                [texts.clipped(str(message.get("role", ""))), texts.block(message.get("content", ""))]
                for message in one.get("prompt") or ()
                if isinstance(message, Mapping)
            ],
            "reply": texts.block(texts.clipped(str(one.get("reply", "")))),
        }
        for one in value
        if isinstance(one, Mapping)
    ]


def _steps(values: Sequence[int]) -> list[int]:
    """The first value and the changes from each to the next: mostly zeros, which take no room."""
    return [now - before for before, now in zip((0, *values), values)]


def _centimetres(metres: float) -> int:
    return round(100 * metres) if math.isfinite(metres) else 0
