"""What a robot saw when it decided: small pictures, within a bound on their size."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Observation
from adhoc.worlds.colours import colour_of
from adhoc.worlds.world import World

LARGEST = 160
"""Pixels: of the longer side of a picture."""
QUALITY = 60
"""Of JPEG: a picture of 128 x 128 pixels takes about 3 kB."""
NOTHING = (36, 41, 47)
"""Where a camera hits nothing, in pictures of labels."""


def snapshot(world: World, robot: str) -> bytes:
    """A JPEG of what a robot sees now: in colour if the world draws it, else its labels in the colours of
    their categories."""
    from PIL import Image

    observation = world.observe(robot, rgb=True)
    pixels = labels_picture(observation) if observation.rgb is None else observation.rgb
    image = Image.fromarray(pixels)
    image.thumbnail((LARGEST, LARGEST))
    file = io.BytesIO()
    image.save(file, "JPEG", quality=QUALITY, optimize=True)
    return file.getvalue()


def labels_picture(observation: Observation) -> NDArray[np.uint8]:
    """The instances of an observation, (H, W, 3), each in the colour of its category."""
    picture = np.empty((*observation.instances.shape, 3), np.uint8)
    picture[:] = NOTHING
    for instance, label in observation.labels.items():
        picture[observation.instances == instance] = [
            round(255 * channel) for channel in colour_of(label.category)
        ]
    return picture


def within(pictures: Mapping[int, bytes], wanted: Sequence[int], most_bytes: int) -> dict[int, bytes]:
    """Of pictures by number, those that fit into so many bytes in all: the `wanted` ones first, then others,
    each kind spread evenly."""
    kept: dict[int, bytes] = {}
    left = most_bytes
    others = [number for number in pictures if number not in set(wanted)]
    for kind in ([number for number in wanted if number in pictures], others):
        size = sum(len(pictures[number]) for number in kind)
        share = min(1.0, left / size) if size else 0.0
        taken = 0
        for position, number in enumerate(kind):
            if taken >= share * (position + 1) or len(pictures[number]) > left:
                continue
            kept[number] = pictures[number]
            left -= len(pictures[number])
            taken += 1
    return dict(sorted(kept.items()))
