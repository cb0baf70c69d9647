"""The paper's three sub-tasks and seven sub-skills of tidying up."""

from __future__ import annotations

from adhoc.core.calls import CallSpec, Parameter, ParameterKind

_OBJECT = Parameter("object", ParameterKind.OBJECT)
_ROOM = Parameter("room", ParameterKind.ROOM)

EXPLORE = CallSpec(
    "Explore",
    (_ROOM,),
    "Explore the room to search for misplaced objects and to learn what is in the room.",
    steps=("GoToRoom {room}", "Explore"),
)
REPLACE = CallSpec(
    "Re-place",
    (
        _OBJECT,
        Parameter("receptacle_type", ParameterKind.RECEPTACLE_TYPE),
        Parameter("room_type", ParameterKind.ROOM_TYPE),
    ),
    "Put the detected misplaced object into a reasonable type of receptacle in a reasonable type of room.",
    needs_manipulation=True,
    steps=(
        "GoToObject {object}",
        "PickupObject {object}",
        "GoToObject {target}",
        "PutObject {object} {target} {target_room}",
    ),
)
STOP = CallSpec(
    "Stop",
    (),
    "Stop at the current location for good. Only when nothing is left that this robot could do.",
    steps=("Stop",),
)
SUB_TASKS = (EXPLORE, REPLACE, STOP)

SUB_SKILLS = (
    CallSpec("GoToObject", (_OBJECT,), "Navigate to the vicinity of a known object or receptacle."),
    CallSpec(
        "GoToPoint",
        (Parameter("dx", ParameterKind.NUMBER), Parameter("dy", ParameterKind.NUMBER)),
        "Navigate to the point (dx, dy) metres away from the current position, along the x and y axes; at "
        "most 6 m.",
    ),
    CallSpec("GoToRoom", (_ROOM,), "Navigate to a known room."),
    CallSpec(
        "PickupObject",
        (_OBJECT,),
        "Pick up a detected object that is near the robot.",
        needs_manipulation=True,
    ),
    CallSpec(
        "PutObject",
        (_OBJECT, Parameter("receptacle", ParameterKind.RECEPTACLE), _ROOM),
        "Put the held object into or onto the receptacle in the room. The robot must hold the object.",
        needs_manipulation=True,
    ),
    CallSpec("Explore", (), "Explore the area around, or the room of the current sub-task, to learn more."),
    CallSpec("Stop", (), "Stop at the current location for good."),
)
