"""The colours of robots and objects in all pictures, told apart by people with any colour vision.

The robots' are those of Okabe and Ito ('Color Universal Design', 2008) without the yellow, which is lost on
light rooms; a darker orange and an olive stand in for it and for the red, which marks misplaced objects.
"""

from __future__ import annotations

ROBOTS = ("#e69f00", "#0072b2", "#cc79a7", "#009e73", "#56b4e9", "#b3541e", "#8a8a00")
"""Of the teammates in their order, again from the first for more of them."""
NEWCOMER = "#ffffff"
"""White with a dark outline, as in the paper."""
OUTLINE = "#14181f"
MISPLACED = "#c1272d"
REPLACED = "#006e53"
REPLACED_FACE = "#d3efe4"


def robot_colour(position: int) -> str:
    """Of the teammate at a position, from 0."""
    return ROBOTS[position % len(ROBOTS)]
