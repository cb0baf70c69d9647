"""Colours of categories in pictures: calm, and the same on every machine."""

from __future__ import annotations

import colorsys
import hashlib

_HOUSE = {
    "Floor": (0.80, 0.72, 0.60),
    "Wall": (0.93, 0.91, 0.86),
    "Door": (0.62, 0.47, 0.34),
    "Window": (0.70, 0.84, 0.92),
    "Robot": (0.25, 0.42, 0.70),
}


def colour_of(category: str) -> tuple[float, float, float]:
    """Red, green and blue in [0, 1] of a category: fixed for the house itself, hashed for objects."""
    if category in _HOUSE:
        return _HOUSE[category]
    digest = hashlib.sha256(category.encode()).digest()
    hue, saturation, value = digest[0] / 256, 0.22 + 0.23 * digest[1] / 255, 0.7 + 0.25 * digest[2] / 255
    return colorsys.hsv_to_rgb(hue, saturation, value)
