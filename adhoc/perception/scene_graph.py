"""The hierarchical scene graph: house, rooms, receptacles, objects (paper, Visual Semantic Perception)."""

from __future__ import annotations

from collections.abc import Iterator

import networkx as nx

from adhoc.core.values import ObjectRecord

HOUSE = "house"
"""The root."""


class SceneGraph:
    """A tree of what was detected, and of nothing else: house -> room -> receptacle -> object.

    An object hangs below its receptacle where that is known, else below its room, else below the house.
    What lies on the floor hangs below its room. Nodes carry `kind` (`house`, `room` or `object`) and
    `category`.

    Attributes:
        graph: The `networkx.DiGraph`; treat it as read-only.
    """

    def __init__(self) -> None:
        self.graph = nx.DiGraph()
        self.graph.add_node(HOUSE, kind="house", category="House")

    def __contains__(self, node: str) -> bool:
        return node in self.graph

    def set_room(self, room_id: str, room_type: str | None = None) -> None:
        """Add a room, or update its type (None while undecided)."""
        self.graph.add_node(room_id, kind="room", category=room_type)
        self.graph.add_edge(HOUSE, room_id)

    def place(self, record: ObjectRecord) -> None:
        """Add an object, or move it to where the record says that it is."""
        self.graph.add_node(record.id, kind="object", category=record.category)
        parent = self._parent_of(record)
        before = self.parent(record.id)
        if before == parent:
            return
        if before is not None:
            self.graph.remove_edge(before, record.id)
        self.graph.add_edge(parent, record.id)

    def remove(self, object_id: str) -> None:
        """Take an object out; what lay in or on it moves to the place where it was."""
        if object_id not in self.graph:
            return
        parent = self.parent(object_id) or HOUSE
        for child in list(self.graph.successors(object_id)):
            self.graph.add_edge(parent, child)
        self.graph.remove_node(object_id)

    def parent(self, node: str) -> str | None:
        """What the node hangs below; None for the house and for what is not in the graph."""
        return next(iter(self.graph.predecessors(node)), None) if node in self.graph else None

    def children(self, node: str) -> tuple[str, ...]:
        """What hangs directly below the node, sorted."""
        return tuple(sorted(self.graph.successors(node))) if node in self.graph else ()

    def as_text(self) -> str:
        """The tree as indented lines, `id (category)`, for prompts and for people."""
        return "\n".join(self._lines(HOUSE, 0))

    def _lines(self, node: str, depth: int) -> Iterator[str]:
        category = self.graph.nodes[node]["category"] or "type unknown"
        yield f"{'  ' * depth}{node}" + ("" if node == HOUSE else f" ({category})")
        for child in self.children(node):
            yield from self._lines(child, depth + 1)

    def _parent_of(self, record: ObjectRecord) -> str:
        if record.receptacle is not None and self._may_hang_below(record.id, record.receptacle):
            return record.receptacle
        return record.room if record.room is not None and record.room in self.graph else HOUSE

    def _may_hang_below(self, node: str, parent: str) -> bool:
        ancestor: str | None = parent if parent in self.graph else None
        while ancestor is not None and ancestor not in (HOUSE, node):
            ancestor = self.parent(ancestor)
        return ancestor == HOUSE
