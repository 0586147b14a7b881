# SPDX-License-Identifier: GPL-3.0-or-later
"""Obstacles: flat and wavy walls."""

from __future__ import annotations

import numpy as np

from .primitives import box, grid, triangulated
from .shape import Shape


def wavy_wall(cells: int = 24, size: float = 4.0, amplitude: float = 0.15) -> Shape:
    """A sheet around the plane z = 0 with hills and valleys of `amplitude`."""
    flat = grid(cells, cells, size, size)
    x, y = flat.vertices[:, 0], flat.vertices[:, 1]
    height = amplitude * np.sin(4 * x) * np.cos(3 * y)
    return triangulated(Shape(np.column_stack([x, y, height]), flat.faces))


def slab(size: float = 4.0, thickness: float = 0.2) -> Shape:
    """A closed plate whose upper face lies at z = 0."""
    return box(4, (size, size, thickness)).moved((0, 0, -thickness / 2))
