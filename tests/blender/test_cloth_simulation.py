# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's cloth simulation as an opponent: the body follows its goal, the cloth responds, fabric shrinks."""

import numpy as np
import pytest

from benchmarks.sessions.cloth_simulation import simulate_cloth
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated


def sheet(height):
    flat = triangulated(grid(12, 12, 2, 2)).moved((0, 0, height))
    return flat.vertices, flat.triangles()


def ball(radius):
    round_ = icosphere(2, radius)
    return round_.vertices, round_.triangles()


def test_a_growing_body_pushes_the_cloth_away():
    body, cloth = ball(0.5), sheet(0.55)
    run = simulate_cloth(cloth, body, 2 * body[0], 12)
    middle = np.linalg.norm(cloth[0][:, :2], axis=1).argmin()
    assert run.cloth.shape == cloth[0].shape and len(run.seconds) == 12
    assert run.cloth[middle, 2] > 0.9
    left_alone = simulate_cloth(cloth, body, body[0], 12)
    assert np.allclose(left_alone.cloth, cloth[0], atol=0.02)  # it has no weight


def test_fabric_shrinks_by_the_given_fraction():
    body, cloth = ball(0.2), sheet(3.0)
    run = simulate_cloth(cloth, body, body[0], 30, shrink=0.3)
    assert np.ptp(run.cloth, axis=0)[:2] == pytest.approx([1.4, 1.4], abs=0.1)
