# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed surfaces around cells of a grid: rooms, corners, and cages of figures."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np

from .shape import Shape

Cell = tuple[int, int, int]


def voxel_surface(cells: Iterable[Cell]) -> Shape:
    """The quads between cells (unit cubes) and empty space, counter-clockwise seen from outside."""
    filled = set(cells)
    index: dict[tuple[int, ...], int] = {}
    faces = []
    for cell, axis, side in itertools.product(sorted(filled), range(3), (0, 1)):
        beside = list(cell)
        beside[axis] += 2 * side - 1
        if tuple(beside) in filled:
            continue
        corners = []
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
            place = list(cell)
            place[axis] += side
            place[(axis + 1) % 3] += a
            place[(axis + 2) % 3] += b
            corners.append(index.setdefault(tuple(place), len(index)))
        faces.append(tuple(corners if side else corners[::-1]))
    return Shape(np.array(list(index), float), tuple(faces))
