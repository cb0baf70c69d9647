"""The box ray-caster: depth and instances of upright boxes, exact and fast.

It samples where PyBullet's TinyRenderer does, so that both give the same picture. Per box: cull against
the view frustum, project to a rectangle of the screen, solve per row which pixels the box covers, and
z-test only those.

For a ray `forward + u * right + v * down` from the camera, the inverse of the depth at which it meets a
plane is linear in u and v. A ray enters a convex body where the inverse depth of the planes that face the
camera is smallest, and leaves it where that of the planes that face away is largest: the pixels of a row
that a box covers are an interval, and no pixel needs more than three multiplications and one division.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

NEAREST = 0.01
"""Nothing closer to the camera than this is seen, in metres along the optical axis."""
_FARTHEST_INVERSE = 1e-6
_TIE = 1.0 - 1e-6
_IN_PLANE = 1e-9

Floats = NDArray[np.float64]


@numba.njit(cache=True, nogil=True)
def cast_boxes(
    centers: Floats,
    halves: Floats,
    headings: Floats,
    instances: NDArray[np.int32],
    layers: NDArray[np.uint8],
    drawn_layers: int,
    own_instance: int,
    intrinsics: Floats,
    world_from_camera: Floats,
    depth: NDArray[np.float32],
    owners: NDArray[np.int32],
) -> int:
    """Draw the boxes of some layers into a picture that may already hold others.

    Of two boxes at exactly the same depth the one of the smaller instance is seen, so that the picture
    does not depend on the order of drawing. A box around the camera is not seen.

    Args:
        centers, halves, headings, instances, layers: the arrays of a `BoxTable`.
        drawn_layers: the bits of the layers to draw.
        own_instance: the instance that is not drawn (the camera's own body), or -1.
        intrinsics: (3, 3) pinhole matrix.
        world_from_camera: (4, 4) pose of the camera; its x axis must be horizontal.
        depth: (H, W) float32, metres along the optical axis, changed in place.
        owners: (H, W) int32, the instance that is seen, changed in place.

    Returns:
        The number of pixels written; 0 means that the picture is unchanged.
    """
    height, width = depth.shape
    focal_u, focal_v = intrinsics[0, 0], intrinsics[1, 1]
    center_u, center_v = intrinsics[0, 2], intrinsics[1, 2]
    u_low, u_high = (0.0 - center_u) / focal_u, (width - 1.0 - center_u) / focal_u
    v_low, v_high = (0.0 - center_v) / focal_v, (height - 1.0 - center_v) / focal_v
    u_slack = math.sqrt(1.0 + max(u_low * u_low, u_high * u_high))
    v_slack = math.sqrt(1.0 + max(v_low * v_low, v_high * v_high))
    right, down = world_from_camera[:3, 0], world_from_camera[:3, 1]
    forward, eye = world_from_camera[:3, 2], world_from_camera[:3, 3]

    # Inverse depth of a plane is plane[0] + plane[1] * u + plane[2] * v.
    fronts = np.empty((3, 3))
    backs = np.empty((6, 3))
    front_axes = np.empty(3, np.int64)
    back_axes = np.empty(6, np.int64)
    bounds = np.empty((24, 3))
    axes = np.empty((3, 3))
    offset = np.empty(3)
    written = 0

    for box in range(centers.shape[0]):
        if (layers[box] & drawn_layers) == 0 or instances[box] == own_instance:
            continue
        dx = centers[box, 0] - eye[0]
        dy = centers[box, 1] - eye[1]
        dz = centers[box, 2] - eye[2]
        half_x, half_y, half_z = halves[box, 0], halves[box, 1], halves[box, 2]
        radius = math.sqrt(half_x * half_x + half_y * half_y + half_z * half_z)
        along = dx * forward[0] + dy * forward[1] + dz * forward[2]
        if along + radius < NEAREST:
            continue
        across = dx * right[0] + dy * right[1] + dz * right[2]
        if across - along * u_high > radius * u_slack or across - along * u_low < -radius * u_slack:
            continue
        below = dx * down[0] + dy * down[1] + dz * down[2]
        if below - along * v_high > radius * v_slack or below - along * v_low < -radius * v_slack:
            continue

        # The camera in the frame of the box: rows right, down, forward; columns the axes of the box.
        cosine, sine = headings[box, 0], headings[box, 1]
        for row in range(3):
            vector = world_from_camera[:3, row]
            axes[row, 0] = cosine * vector[0] + sine * vector[1]
            axes[row, 1] = cosine * vector[1] - sine * vector[0]
            axes[row, 2] = vector[2]
        offset[0] = -(cosine * dx + sine * dy)
        offset[1] = -(cosine * dy - sine * dx)
        offset[2] = -dz

        # Screen rectangle of the eight corners; the whole screen if one of them is behind the camera.
        left, rightmost, top, bottom = math.inf, -math.inf, math.inf, -math.inf
        behind = 0
        for corner in range(8):
            sx = half_x if corner & 1 else -half_x
            sy = half_y if corner & 2 else -half_y
            sz = half_z if corner & 4 else -half_z
            z = along + sx * axes[2, 0] + sy * axes[2, 1] + sz * axes[2, 2]
            if z < NEAREST:
                behind += 1
                continue
            u = (across + sx * axes[0, 0] + sy * axes[0, 1] + sz * axes[0, 2]) / z
            v = (below + sx * axes[1, 0] + sy * axes[1, 1] + sz * axes[1, 2]) / z
            left, rightmost = min(left, u), max(rightmost, u)
            top, bottom = min(top, v), max(bottom, v)
        if behind == 8:
            continue
        if behind > 0:
            left, rightmost, top, bottom = u_low, u_high, v_low, v_high
        first_column = max(0, math.ceil(max(left, u_low - 1.0) * focal_u + center_u - 1e-9))
        last_column = min(width - 1, math.floor(min(rightmost, u_high + 1.0) * focal_u + center_u + 1e-9))
        first_row = max(0, math.ceil(max(top, v_low - 1.0) * focal_v + center_v - 1e-9))
        last_row = min(height - 1, math.floor(min(bottom, v_high + 1.0) * focal_v + center_v + 1e-9))
        if first_column > last_column or first_row > last_row:
            continue

        # The planes that face the camera, and those that face away. A plane through the camera has no
        # inverse depth, but still bounds the box: only rays to its inner side can meet the box.
        front_count, back_count, bound_count = 0, 0, 0
        for axis in range(3):
            half = halves[box, axis]
            for side in (-1.0, 1.0):
                distance = side * half - offset[axis]
                if abs(distance) < _IN_PLANE:
                    bounds[bound_count, 0] = -side * axes[2, axis]
                    bounds[bound_count, 1] = -side * axes[0, axis]
                    bounds[bound_count, 2] = -side * axes[1, axis]
                    bound_count += 1
                    continue
                scale = 1.0 / distance
                if distance * side < 0.0:
                    front_axes[front_count] = axis
                    fronts[front_count, 0] = axes[2, axis] * scale
                    fronts[front_count, 1] = axes[0, axis] * scale
                    fronts[front_count, 2] = axes[1, axis] * scale
                    front_count += 1
                else:
                    back_axes[back_count] = axis
                    backs[back_count, 0] = axes[2, axis] * scale
                    backs[back_count, 1] = axes[0, axis] * scale
                    backs[back_count, 2] = axes[1, axis] * scale
                    back_count += 1
        if front_count == 0:
            continue

        # A pixel is covered where each bound is not negative.
        for front in range(front_count):
            bounds[bound_count, 0] = fronts[front, 0] - _FARTHEST_INVERSE
            bounds[bound_count, 1] = fronts[front, 1]
            bounds[bound_count, 2] = fronts[front, 2]
            bound_count += 1
            for back in range(back_count):
                if back_axes[back] == front_axes[front]:
                    continue
                bounds[bound_count, 0] = fronts[front, 0] - backs[back, 0]
                bounds[bound_count, 1] = fronts[front, 1] - backs[back, 1]
                bounds[bound_count, 2] = fronts[front, 2] - backs[back, 2]
                bound_count += 1
        for missing in range(front_count, 3):
            for term in range(3):
                fronts[missing, term] = fronts[0, term]

        owner = instances[box]
        for row in range(first_row, last_row + 1):
            v = (row - center_v) / focal_v
            u_from = (first_column - center_u) / focal_u
            u_to = (last_column - center_u) / focal_u
            for bound in range(bound_count):
                constant = bounds[bound, 0] + bounds[bound, 2] * v
                slope = bounds[bound, 1]
                if slope > 1e-12:
                    u_from = max(u_from, -constant / slope)
                elif slope < -1e-12:
                    u_to = min(u_to, -constant / slope)
                elif constant < 0.0:
                    u_to = -math.inf
            if u_from > u_to:
                continue
            column_from = max(first_column, math.ceil(u_from * focal_u + center_u - 1e-9))
            column_to = min(last_column, math.floor(u_to * focal_u + center_u + 1e-9))
            start0 = fronts[0, 0] + fronts[0, 2] * v - fronts[0, 1] * center_u / focal_u
            start1 = fronts[1, 0] + fronts[1, 2] * v - fronts[1, 1] * center_u / focal_u
            start2 = fronts[2, 0] + fronts[2, 2] * v - fronts[2, 1] * center_u / focal_u
            slope0, slope1, slope2 = fronts[0, 1] / focal_u, fronts[1, 1] / focal_u, fronts[2, 1] / focal_u
            if column_to < column_from:
                continue
            # Unsigned, so that compiled code need not ask whether an index counts from the end.
            for column in range(np.uint64(column_from), np.uint64(column_to + 1)):
                inverse = min(start0 + slope0 * column, start1 + slope1 * column, start2 + slope2 * column)
                seen = depth[row, column]
                if inverse * seen < _TIE or inverse <= 0.0:
                    continue
                hit = np.float32(1.0 / inverse)
                if hit < seen or (hit == seen and owner < owners[row, column]):
                    depth[row, column] = hit
                    owners[row, column] = owner
                    written += 1
    return written
