# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed surfaces swept from rings: tubes along a path and solids of revolution."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .shape import Shape


def capped_rings(rings: NDArray[np.float64], first: NDArray[np.float64], last: NDArray[np.float64]) -> Shape:
    """A closed triangle mesh through `rings` (R, S, 3), closed by fans to the points `first` and `last` (3,).

    Each ring runs counter-clockwise seen from the far end of the sweep, so that faces point outward. S R + 2 vertices,
        2 S R triangles.
    """
    count, sides = rings.shape[:2]
    vertices = np.concatenate([first[None], rings.reshape(-1, 3), last[None]])
    end = len(vertices) - 1
    faces: list[tuple[int, ...]] = []
    for j in range(sides):
        k = (j + 1) % sides
        faces.append((0, 1 + k, 1 + j))
        for i in range(count - 1):
            a, b, c, d = 1 + i * sides + j, 1 + i * sides + k, 1 + (i + 1) * sides + k, 1 + (i + 1) * sides + j
            faces += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
        last_ring = 1 + (count - 1) * sides
        faces.append((last_ring + j, last_ring + k, end))
    return Shape(vertices, tuple(faces))


def tube(path: NDArray[np.float64], radii: NDArray[np.float64], sides: int, cap: float = 1.0) -> Shape:
    """A closed tube along `path` (R, 3) with `radii` (R,), without twist, with tips `cap` radii beyond the ends."""
    tangents = np.gradient(path, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    across = np.cross(tangents[0], [0.31, 0.93, 0.17])
    angles = 2 * np.pi * np.arange(sides) / sides
    rings = np.empty((len(path), sides, 3))
    for i, (point, tangent, radius) in enumerate(zip(path, tangents, radii, strict=True)):
        across = across - tangent * (across @ tangent)  # parallel transport: the ring does not twist
        across /= np.linalg.norm(across)
        other = np.cross(tangent, across)
        rings[i] = point + radius * (np.outer(np.cos(angles), across) + np.outer(np.sin(angles), other))
    first = path[0] - cap * radii[0] * tangents[0]
    return capped_rings(rings, first, path[-1] + cap * radii[-1] * tangents[-1])


def revolution(profile: NDArray[np.float64], sides: int) -> Shape:
    """A closed solid about the z axis from `profile` (R, 2) of radius and height; its ends lie on the axis.

    The solid lies to the left of the profile: bottom centre, outside, upward.
    """
    angles = 2 * np.pi * np.arange(sides) / sides
    radius, height = profile[1:-1, 0, None], profile[1:-1, 1, None]
    rings = np.stack(
        [radius * np.cos(angles), radius * np.sin(angles), np.broadcast_to(height, (len(radius), sides))], 2
    )
    return capped_rings(rings, np.array([0, 0, profile[0, 1]]), np.array([0, 0, profile[-1, 1]]))


def trefoil(rings: int, sides: int) -> Shape:
    """A closed quad tube along a trefoil knot, whose frames close after one round."""
    t = 2 * np.pi * np.arange(rings) / rings
    path = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    tangent = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    across = np.cross(tangent, [0.0, 0.0, 1.0])  # never parallel to the axis on this knot
    across /= np.linalg.norm(across, axis=1)[:, None]
    other = np.cross(tangent, across)
    angle = 2 * np.pi * np.arange(sides) / sides
    turned = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * other[:, None]
    faces = []
    for i, j in np.ndindex(rings, sides):
        ahead, beside = (i + 1) % rings, (j + 1) % sides
        faces.append((i * sides + j, i * sides + beside, ahead * sides + beside, ahead * sides + j))
    return Shape((path[:, None] + 0.55 * turned).reshape(-1, 3), tuple(faces))
