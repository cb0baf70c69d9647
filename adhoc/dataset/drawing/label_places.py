"""Places for labels and marks of a picture where they do not cover each other."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

Rectangle = tuple[float, float, float, float]
"""x0, y0, x1, y1."""

DIRECTIONS = 16
RINGS = 6


@dataclass
class LabelPlaces:
    """Rectangles taken so far, in any unit, and where there is still room beside a point.

    Args of the constructor: `bounds`, which labels should not leave.
    """

    bounds: Rectangle
    taken: list[Rectangle] = field(default_factory=list)

    def take(self, x: float, y: float, width: float, height: float) -> None:
        """Keep others away from a rectangle around (x, y)."""
        self.taken.append((x - width / 2, y - height / 2, x + width / 2, y + height / 2))

    def is_free(self, x: float, y: float, width: float, height: float) -> bool:
        """Whether nothing is taken in a rectangle around (x, y)."""
        return self._covered(x, y, width, height) < 1e-9

    def beside(
        self, x: float, y: float, width: float, height: float, gap: float = 0.0
    ) -> tuple[float, float]:
        """The centre of a free rectangle of that size near (x, y), which it takes: right of it if it can.

        Where all places near are covered in part, the one that covers least; rings of places go ever further
        out, beginning `gap` away from the point.
        """
        best, least = (x, y), math.inf
        for ring in range(RINGS):
            distance = gap + ring * height / 2
            for number in range(DIRECTIONS):
                angle = 2 * math.pi * ((number + 1) // 2 * (-1) ** number) / DIRECTIONS
                centre = (
                    x + math.cos(angle) * (distance + width / 2),
                    y + math.sin(angle) * (distance + height / 2),
                )
                covered = self._covered(*centre, width, height) + 1e-6 * ring * width * height
                if covered < least - 1e-12:
                    best, least = centre, covered
            if least <= 1e-6 * ring * width * height:
                break
        self.take(*best, width, height)
        return best

    def _covered(self, x: float, y: float, width: float, height: float) -> float:
        """The area that a rectangle shares with taken ones, or has outside the bounds."""
        x0, y0, x1, y1 = x - width / 2, y - height / 2, x + width / 2, y + height / 2
        left, low, right, high = self.bounds
        inside = max(0.0, min(x1, right) - max(x0, left)) * max(0.0, min(y1, high) - max(y0, low))
        shared = sum(
            max(0.0, min(x1, other[2]) - max(x0, other[0])) * max(0.0, min(y1, other[3]) - max(y0, other[1]))
            for other in self.taken
        )
        return width * height - inside + shared
