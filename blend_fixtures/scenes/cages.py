# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures with cages: a sheet that folds onto itself, and an open cage with creases."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .colors import MOVING, STILL
from .fixture import Fixture, MeshObject, Placement, Subdivision, View
from .motion import move, on_points
from .primitives import grid, icosphere, triangulated
from .shape import Shape


def bent_sheet(angle: float, radius: float = 0.15, length: float = 2.0, cells: int = 24) -> Shape:
    """A sheet bent about the y axis by `angle` radians along an arc of `radius`; its left half stays in z = 0."""
    flat = triangulated(grid(cells, cells, length, 1.0))
    along, y = flat.vertices[:, 0], flat.vertices[:, 1]
    arc = np.clip(along + radius * angle / 2, 0, radius * angle) / radius  # angle along the arc, radians
    before = np.minimum(along + radius * angle / 2, 0)
    after = np.maximum(along - radius * angle / 2, 0)
    x = before + radius * np.sin(arc) + after * np.cos(angle)
    z = radius * (1 - np.cos(arc)) + after * np.sin(angle)
    ripple = 0.02 * np.sin(9 * y) * np.abs(along)
    return Shape(np.column_stack([x, y, z + ripple]), flat.faces)


def self_folding_sheet() -> Fixture:
    """A sheet bent back over itself, whose upper flap is pushed through its lower half."""
    sheet = bent_sheet(0.8 * np.pi)
    flap = np.flatnonzero(np.arange(len(sheet.vertices)) >= 18 * 25)  # columns of the grid beyond the bend
    return Fixture(
        name="self_folding_sheet",
        summary="A sheet folded onto itself: the flap is pushed through the lower half",
        meshes=(MeshObject("Sheet", sheet, MOVING),),
        steps=(move(on_points("Sheet", flap.tolist()), (0.0, 0.0, -0.35), repeat=4),),
        view=View((0.8, -3.0, 1.3), (-0.4, 0.0, 0.2)),
    )


def _bowl() -> tuple[Shape, tuple[tuple[int, int, float], ...], tuple[tuple[int, float], ...]]:
    """An open bowl with eight sides: an octagonal floor, quads, one quad split into triangles, and creases."""
    rings = [(0.55, -0.6), (0.9, 0.0), (1.0, 0.7)]
    angles = 2 * np.pi * np.arange(8) / 8
    levels: list[NDArray[np.float64]] = [
        np.stack([r * np.cos(angles), r * np.sin(angles), np.full(8, z)], 1) for r, z in rings
    ]
    faces: list[tuple[int, ...]] = [tuple(range(8))[::-1]]
    for ring in range(2):
        for j in range(8):
            k = (j + 1) % 8
            faces.append((8 * ring + j, 8 * ring + k, 8 * ring + 8 + k, 8 * ring + 8 + j))
    a, b, c, d = faces.pop()
    faces += [(a, b, c), (a, c, d)]
    sharp = tuple((j, (j + 1) % 8, 1.0) for j in range(8))
    soft = tuple((8 + j, 8 + (j + 1) % 8, 0.5) for j in range(4))
    return Shape(np.concatenate(levels), tuple(faces)), sharp + soft, ((16, 1.0), (20, 0.6))


def cage_with_creases_and_boundary() -> Fixture:
    """An open bowl with sharp and soft creases, lowered over a ball."""
    bowl, edges, vertices = _bowl()
    return Fixture(
        name="cage_with_creases_and_boundary",
        summary="An open cage with creases, a boundary, an octagon and triangles, pressed onto a ball",
        meshes=(
            MeshObject("Bowl", bowl, MOVING, Placement((0.0, 0.0, 1.4)), subdivision=Subdivision(2, edges, vertices)),
            MeshObject("Ball", icosphere(3, 0.6), STILL),
        ),
        steps=(
            move(on_points("Bowl"), (0.05, 0.03, -0.25), repeat=3),
            move(on_points("Bowl", range(16, 24)), (0.3, 0.0, -0.5), repeat=2),
        ),
        view=View((4.6, -6.4, 4.2), (0.0, 0.0, 0.8)),
    )
