"""The parameters of perception, with the reasons for their defaults."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.errors import ConfigurationError


@dataclass(frozen=True)
class PerceptionSettings:
    """Parameters of visual semantic perception. The paper gives none of them. Metres unless said.

    Raises ConfigurationError where a value makes no map possible.
    """

    cell: float = 0.05
    """Side of a voxel and of a map cell; one metre must be a whole number of cells. 0.05 is a quarter of a
    robot's radius and a fifth of its step."""
    max_depth: float = 4.0
    """Pixels farther along the optical axis are ignored: the usual range of an RGB-D camera."""
    floor_depth: float = 3.0
    """Floor farther along the optical axis does not count as seen yet, so that exploration comes near enough
    to detect small things: on eight real one-room houses it finds 94% of the portable objects where 4 m
    finds 87%, for a third more steps."""
    extent: float = 56.0
    """Side of the square that the map can hold, centred on the first pose. Memory is only touched where
    something is seen. A house of 25 x 25 m fits wherever in it the robot begins."""
    robot_radius: float = 0.2
    """Cells nearer to an obstacle are not traversable (AI2-THOR's agents have this radius)."""
    obstacle_top: float = 1.7
    """What begins above is no obstacle: it hangs over the tallest robot."""
    moved_distance: float = 0.3
    """An object seen at least this far from its record has moved."""
    gone_range: float = 2.5
    """An object that is not seen where it should be is declared gone only within this distance."""
    gone_looks: int = 2
    """So many frames must look through an object's place before it is gone."""
    robot_memory: int = 10
    """Steps for which a robot that went out of view is still believed where it was: a way around it must not
    look blocked and free in turn as the camera turns."""
    floor_tolerance: float = 0.1
    """An object whose bottom is lower may lie on the floor."""
    frontier_cells: int = 8
    """Frontiers of fewer cells are noise (8 cells are 0.4 m, a robot's width)."""
    inspected_share: float = 0.6
    """A square metre counts as inspected when this share of it is known, or when nothing in it borders on
    the unknown and a fifth of it is known."""
    explored_area: float = 1.5
    """A room counts as explored only when at least this much of its floor, in square metres, is known."""
    room_certainty: float = 0.5
    """A room's type is named when its probability is above this."""
    item_evidence: float = 0.25
    """Weight of portable objects as evidence of a room's type, furniture being 1: some are misplaced."""

    def __post_init__(self) -> None:
        cells = 1.0 / self.cell if self.cell > 0 else 0.0
        if self.cell <= 0 or abs(cells - round(cells)) > 1e-9:
            raise ConfigurationError(
                f"PerceptionSettings.cell is {self.cell}: a metre must be a whole number of cells (0.05: 20)"
            )
        if self.max_depth <= 0 or self.extent < 4 * self.max_depth:
            raise ConfigurationError(
                f"PerceptionSettings: max_depth {self.max_depth} must be positive and extent {self.extent} "
                "at least four times as much"
            )

    @property
    def cells_per_metre(self) -> int:
        """Cells along one metre."""
        return round(1.0 / self.cell)
