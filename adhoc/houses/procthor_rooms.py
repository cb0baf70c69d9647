"""Rooms and walls of ProcTHOR house JSON."""

from __future__ import annotations

from adhoc.core.errors import HouseError
from adhoc.houses import floor_plan
from adhoc.houses.facts import CORRIDOR, ROOM_TYPES
from adhoc.houses.house import Corner, Room
from adhoc.houses.json_fields import Fields
from adhoc.houses.wall_merging import TOLERANCE, Stretch, WallSide

SMALLEST_ROOM = 0.25
"""Square metres; anything smaller is no room but a broken polygon."""
MOST_CORNERS = 500


def parse_rooms(house: Fields) -> tuple[Room, ...]:
    """The rooms. Raises HouseError unless there are any, each a simple rectilinear polygon of a known type,
    none over another."""
    rooms = tuple(_parse_room(fields) for fields in house.items("rooms"))
    if not rooms:
        raise house.error("rooms", "a list of at least one room")
    covers = [floor_plan.rectangles(room.polygon) for room in rooms]
    for index, room in enumerate(rooms):
        for other in range(index):
            if floor_plan.overlap(covers[index], covers[other]) > SMALLEST_ROOM / 10:
                raise HouseError(f"{house.source}: rooms {rooms[other].id!r} and {room.id!r} overlap")
    return rooms


def parse_wall_sides(house: Fields, rooms: tuple[Room, ...]) -> tuple[WallSide, ...]:
    """The walls as the file gives them, one per side. Raises HouseError if one is no upright rectangle."""
    room_ids = {room.id for room in rooms}
    return tuple(_parse_wall_side(fields, room_ids) for fields in house.items("walls"))


def check_enclosed(rooms: tuple[Room, ...], stretches: tuple[Stretch, ...], source: str) -> None:
    """Raises HouseError if an edge of a room has neither a wall nor an opening to another room."""
    for room in rooms:
        for start, end in floor_plan.edges(room.polygon):
            axis = 0 if start[1] == end[1] else 1
            low, high = sorted((start[axis], end[axis]))
            covered = sum(
                max(0.0, min(high, stretch.high) - max(low, stretch.low))
                for stretch in stretches
                if stretch.axis == axis
                and room.id in stretch.rooms
                and abs(stretch.offset - start[1 - axis]) <= 2 * TOLERANCE
            )
            if covered < high - low - 4 * TOLERANCE:
                raise HouseError(f"{source}: walls: room {room.id!r} has no wall from {start} to {end}")


def _parse_room(fields: Fields) -> Room:
    room_type = fields.text("roomType")
    if room_type not in (*ROOM_TYPES, CORRIDOR):
        raise fields.error("roomType", f"one of {', '.join((*ROOM_TYPES, CORRIDOR))}")
    corners = [point.point()[:2] for point in fields.items("floorPolygon")]
    if len(corners) > MOST_CORNERS:
        raise fields.error("floorPolygon", f"a list of at most {MOST_CORNERS} corners")
    polygon = tuple(_straightened(corners))
    wrong = _polygon_fault(polygon)
    if wrong is not None:
        raise fields.error("floorPolygon", f"a simple outline with edges along x and z, but {wrong}")
    return Room(fields.text("id"), room_type, polygon)


def _straightened(corners: list[Corner]) -> list[Corner]:
    """The corners with coordinates that differ by less than a tolerance made equal along each edge."""
    straight: list[Corner] = []
    for x, y in corners:
        if straight:
            before_x, before_y = straight[-1]
            x = before_x if abs(x - before_x) < TOLERANCE else x
            y = before_y if abs(y - before_y) < TOLERANCE else y
        straight.append((x, y))
    if len(straight) > 1:
        (first_x, first_y), (last_x, last_y) = straight[0], straight[-1]
        if 0 < abs(last_x - first_x) < TOLERANCE:
            straight = [(first_x if x == last_x else x, y) for x, y in straight]
        if 0 < abs(last_y - first_y) < TOLERANCE:
            straight = [(x, first_y if y == last_y else y) for x, y in straight]
    return straight


def _polygon_fault(polygon: tuple[Corner, ...]) -> str | None:
    if len(polygon) < 4:
        return f"it has only {len(polygon)} corners"
    if len(set(polygon)) != len(polygon):
        return "a corner is given twice"
    edges = floor_plan.edges(polygon)
    for start, end in edges:
        if (start[0] == end[0]) == (start[1] == end[1]):
            return f"the edge from {start} to {end} is oblique"
    if floor_plan.area(polygon) < SMALLEST_ROOM:
        return f"its area is {floor_plan.area(polygon):g} square metres"
    for index, edge in enumerate(edges):
        for later in range(index + 1, len(edges)):
            neighbours = later == index + 1 or (index == 0 and later == len(edges) - 1)
            if _cross(edge, edges[later]) and not (neighbours and not _fold(edge, edges[later])):
                return f"its edges from {edge[0]} and from {edges[later][0]} meet"
    return None


def _cross(first: tuple[Corner, Corner], second: tuple[Corner, Corner]) -> bool:
    """Whether two axis-parallel edges touch: their bounding boxes meet."""
    return all(
        max(min(first[0][k], first[1][k]), min(second[0][k], second[1][k]))
        <= min(max(first[0][k], first[1][k]), max(second[0][k], second[1][k]))
        for k in (0, 1)
    )


def _fold(first: tuple[Corner, Corner], second: tuple[Corner, Corner]) -> bool:
    """Whether two edges that share a corner run back over each other."""
    ax, ay = first[1][0] - first[0][0], first[1][1] - first[0][1]
    bx, by = second[1][0] - second[0][0], second[1][1] - second[0][1]
    return ax * bx + ay * by < 0


def _parse_wall_side(fields: Fields, room_ids: set[str]) -> WallSide:
    wall_id = fields.text("id")
    points = [point.point() for point in fields.items("polygon")]
    if len(points) != 4:
        raise fields.error("polygon", "a list of 4 points")
    middle = (min(z for *_, z in points) + max(z for *_, z in points)) / 2
    ground = [(x, y) for x, y, z in points if z < middle]
    top = [(x, y) for x, y, z in points if z > middle]
    if len(ground) != 2 or len(top) != 2:
        raise fields.error("polygon", "two points on the ground and two above them")
    (ax, ay), (bx, by) = ground
    along_x, along_y = abs(bx - ax) > TOLERANCE, abs(by - ay) > TOLERANCE
    if along_x == along_y:
        raise fields.error("polygon", f"a wall along x or z, not from {ground[0]} to {ground[1]}")
    room = fields.text("roomId")
    exterior = room == "exterior" or wall_id.startswith("wall|exterior")
    if not exterior and room not in room_ids:
        raise fields.error("roomId", "the id of a room, or 'exterior'")
    height = max(z for *_, z in points) - min(z for *_, z in points)
    return WallSide(wall_id, None if exterior else room, ground[0], ground[1], height, fields.flag("empty"))
