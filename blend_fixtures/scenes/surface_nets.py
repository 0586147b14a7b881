# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of implicit solids: one vertex in each cell that the surface crosses [Gibson 1998]."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .fields import Field
from .shape import Shape

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def surface_net(solid: Field, low: ArrayLike, high: ArrayLike, cell: float, relaxation: int = 5) -> Shape:
    """A closed mesh of quads around `solid`, in cells of size `cell` that fill the box `low` .. `high`.

    The solid lies within the box, and is everywhere thicker than about two cells. `relaxation` is the number of times
        that vertices move to the mean of their neighbours and back onto the surface, which makes the quads more even.
    """
    origin = np.asarray(low, float)
    counts = np.ceil((np.asarray(high, float) - origin) / cell).astype(int) + 1
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), axis=3)
    inside = solid((origin + cell * grid).reshape(-1, 3)).reshape(counts) < 0
    quads = _quads(inside)
    cells, faces = np.unique(quads, return_inverse=True)
    faces = faces.reshape(-1, 4)
    place = np.stack(np.unravel_index(cells, counts), axis=1)
    vertices = _on_surface(solid, origin + cell * (place + 0.5), cell, 2)
    for _ in range(relaxation):
        vertices = _on_surface(solid, _evened(vertices, faces), cell, 1)
    vertices = _on_surface(solid, vertices, cell, 2)
    return Shape(vertices, tuple(map(tuple, faces.tolist())))


def _quads(inside: NDArray[np.bool_]) -> Indices:
    """Indices (q, 4) of the four cells around each grid edge that crosses the surface, counter-clockwise from
    outside.
    """
    strides = np.array([inside.shape[1] * inside.shape[2], inside.shape[2], 1])
    found = []
    for axis in range(3):
        here = np.moveaxis(inside, axis, 0)[:-1]
        there = np.moveaxis(inside, axis, 0)[1:]
        leaves = np.moveaxis(here & ~there, 0, axis)
        enters = np.moveaxis(~here & there, 0, axis)
        u, v = strides[(axis + 1) % 3], strides[(axis + 2) % 3]
        around = np.array([0, -u, -u - v, -v])
        for crossing, order in ((leaves, around), (enters, around[::-1])):
            corner = np.argwhere(crossing) @ strides
            found.append(corner[:, None] + order)
    return np.concatenate(found)


def _on_surface(solid: Field, points: Array, cell: float, steps: int) -> Array:
    """Points moved along the gradient to zeros of the function, at most one cell per step (Newton's method)."""
    reach = 1e-3 * cell
    for _ in range(steps):
        gradient = np.stack(
            [(solid(points + step) - solid(points - step)) / (2 * reach) for step in reach * np.eye(3)], axis=1
        )
        square = np.maximum((gradient**2).sum(axis=1), 1e-2)
        step = gradient * (solid(points) / square)[:, None]
        length = np.linalg.norm(step, axis=1)[:, None]
        points = points - step * np.minimum(1, cell / np.maximum(length, 1e-300))
    return points


def _evened(vertices: Array, faces: Indices) -> Array:
    """Each vertex moved halfway to the mean of its neighbours."""
    ends = np.concatenate([faces, np.roll(faces, 1, axis=1)]).ravel()
    beside = np.concatenate([np.roll(faces, 1, axis=1), faces]).ravel()
    count = np.bincount(ends, minlength=len(vertices))
    total = [np.bincount(ends, vertices[beside, axis], len(vertices)) for axis in range(3)]
    result: Array = (vertices + np.stack(total, axis=1) / count[:, None]) / 2
    return result
