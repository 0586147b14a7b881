# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball above a wavy wall, by default with 75,592 faces, moved by the ball's vertices."""

import numpy as np

import stiv
from blend_fixtures.scenes.primitives import icosphere

SIDE = 167


def wall(side: int) -> tuple[np.ndarray, np.ndarray]:
    axis = np.linspace(-1.5, 1.5, side)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.column_stack([corner, corner + side, corner + side + 1, corner, corner + side + 1, corner + 1])
    return np.column_stack([x.ravel(), y.ravel(), (0.05 * np.sin(4 * x) * np.cos(3 * y)).ravel()]), faces.reshape(-1, 3)


def ball_above_wall(levels: int = 5, side: int = SIDE) -> tuple[stiv.Surface, np.ndarray, np.ndarray]:
    """Surface, positions, and the vertices of the ball."""
    below, faces = wall(side)
    ball = icosphere(levels, 0.6).moved((0, 0, 1.0))
    positions = np.vstack([below, ball.vertices])
    triangles = np.vstack([faces, ball.triangles() + len(below)])
    owner = (np.arange(len(positions)) >= len(below)).astype(np.int32)
    bodies = [stiv.Body("Wall", "fixed"), stiv.Body("Ball", "deformable")]
    return (
        stiv.Surface(triangles, len(positions), None, owner, bodies),
        positions,
        np.flatnonzero(owner).astype(np.int32),
    )


def session(threads: int = 0, levels: int = 5, side: int = SIDE) -> stiv.EditSession:
    """The ball's vertices are the controls."""
    surface, positions, ball = ball_above_wall(levels, side)
    whole = stiv.concatenate([(stiv.identity(len(ball)), ball)], positions)
    return stiv.EditSession(surface, whole, positions[ball], stiv.EditOptions(threads=threads))
