import networkx as nx
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from adhoc.houses.lattice_parts import MOVES, largest_part, steps_between


def lattice(*rows: str) -> np.ndarray:
    """(columns, rows) bool of rows from above: what is not `#`."""
    return np.array([[mark != "#" for mark in row] for row in rows[::-1]]).T


def picture(cells: np.ndarray) -> list[str]:
    return ["".join("o" if cell else "#" for cell in row) for row in cells.T[::-1]]


def all_ways(free: np.ndarray) -> np.ndarray:
    return np.ones_like(free)


def largest(free: np.ndarray) -> np.ndarray:
    return largest_part(free, steps_between(free, all_ways(free), all_ways(free)))


def test_steps_lead_to_free_neighbours_within_the_lattice():
    free = lattice(
        "..#",
        "...",
    )
    steps = steps_between(free, all_ways(free), all_ways(free))
    moves = {cell: {MOVES[move] for move in np.flatnonzero(steps[cell])} for cell in np.ndindex(free.shape)}
    assert moves == {
        (0, 0): {(1, 0), (0, 1)},
        (1, 0): {(1, 0), (-1, 0), (0, 1)},
        (2, 0): {(-1, 0)},
        (0, 1): {(1, 0), (0, -1)},
        (1, 1): {(-1, 0), (0, -1)},
        (2, 1): set(),
    }


def test_a_blocked_way_stops_both_moves_on_it_and_no_other():
    free = lattice("...", "...")
    open_steps = steps_between(free, all_ways(free), all_ways(free))
    east, north = all_ways(free), all_ways(free)
    east[1, 0] = False
    north[2, 0] = False
    closed = np.argwhere(open_steps & ~steps_between(free, east, north)).tolist()
    assert closed == [[1, 0, 0], [2, 0, 1], [2, 0, 2], [2, 1, 3]]


def test_the_largest_of_several_parts():
    free = lattice(
        "..#...",
        ".##.#.",
        "#.#.##",
    )
    assert picture(largest(free)) == [
        "###ooo",
        "###o#o",
        "###o##",
    ]


def test_of_equally_large_parts_the_one_with_the_smallest_column_then_row():
    assert picture(largest(lattice("..#..", "..#.."))) == ["oo###", "oo###"]
    assert picture(largest(lattice("...", "###", "..."))) == ["###", "###", "ooo"]


def test_parts_that_only_a_blocked_way_joins_are_two():
    free = lattice(".....")
    east = all_ways(free)
    east[2, 0] = False
    assert picture(largest_part(free, steps_between(free, east, all_ways(free)))) == ["ooo##"]


def test_a_single_cell_is_a_part_and_no_cell_is_none():
    assert picture(largest(lattice("##", "#."))) == ["##", "#o"]
    assert not largest(lattice("##", "##")).any()


@given(st.data())
def test_the_part_is_the_largest_component_of_the_graph_of_moves(data):
    shape = data.draw(st.tuples(st.integers(1, 6), st.integers(1, 6)))
    flags = st.lists(st.booleans(), min_size=shape[0] * shape[1], max_size=shape[0] * shape[1])
    free, east, north = (np.array(data.draw(flags)).reshape(shape) for _ in range(3))
    graph = nx.Graph()
    graph.add_nodes_from(zip(*np.nonzero(free)))
    for i, j in list(graph):
        for way, neighbour in ((east, (i + 1, j)), (north, (i, j + 1))):
            if way[i, j] and neighbour in graph:
                graph.add_edge((i, j), neighbour)
    parts = sorted(nx.connected_components(graph), key=lambda part: (-len(part), min(part)))
    part = largest_part(free, steps_between(free, east, north))
    assert set(zip(*np.nonzero(part))) == (parts[0] if parts else set())
