# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh moved by handles."""

from __future__ import annotations

import numpy as np

from .colors import MOVING, STILL
from .fixture import Fixture, MeshObject, Placement, Subdivision, VertexGroup, View
from .motion import move, on_objects, on_points, rotate
from .sweeps import tube
from .walls import wavy_wall

RINGS, SIDES = 10, 8


def ring_vertices(first: int, last: int) -> list[int]:
    """Vertices of the rings first .. last of the arm; its tips are the first and the last vertex."""
    return [1 + ring * SIDES + side for ring in range(first, last + 1) for side in range(SIDES)]


def arm_with_handles() -> Fixture:
    """An arm above a wavy wall: its hand is a handle that yields less at the wrist, and its shoulder is pinned."""
    x = np.linspace(-1.3, 1.3, RINGS)
    shape = tube(np.stack([x, 0 * x, 0.15 * np.cos(x)], axis=1), np.full(RINGS, 0.22), SIDES)
    tip = len(shape.vertices) - 1
    hand, wrist = [*ring_vertices(8, 9), tip], ring_vertices(8, 8)
    shoulder = {0, *ring_vertices(0, 0)}
    weights = {vertex: 0.5 if vertex in wrist else 1.0 for vertex in range(tip + 1) if vertex not in shoulder}
    return Fixture(
        name="arm_with_handles",
        summary="An arm whose hand is a handle, its shoulder pinned by weights, pressed into a wavy wall",
        meshes=(
            MeshObject(
                "Arm", shape, MOVING, Placement((0.0, 0.0, 0.75), (0.0, 0.0, 0.3), (1.0, 1.0, 1.1)),
                subdivision=Subdivision(1),
                groups=(VertexGroup("Hand", dict.fromkeys(hand, 1.0)), VertexGroup("Weights", weights)),
            ),
            MeshObject("Wavy wall", wavy_wall(), STILL),
        ),
        steps=(
            move(on_objects(["Arm"]), (0.0, 0.0, -0.2), repeat=5),
            rotate(on_objects(["Arm"]), 0.4, (1.0, 0.0, 0.0)),
            move(on_points("Arm", ring_vertices(4, 5)), (0.0, 0.1, -0.15), repeat=3),
        ),
        view=View((3.0, -4.2, 2.4), (0.0, 0.0, 0.4)),
        settings={"objects": {"Arm": {"deformation": "laplacian", "handles": ["Hand"], "weight_group": "Weights"}}},
    )  # fmt: skip
