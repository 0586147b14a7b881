# SPDX-License-Identifier: GPL-3.0-or-later
"""A box in a slot between two fixed plates, rotated or scaled further than possible."""

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import box, grid, triangulated

GAP = 0.1  # on either side of the box, whose width is 1
BOX = triangulated(box(2, (1, 1, 1)))
PLATE = triangulated(grid(4, 4, 4, 4))
NAMES = ("Böx", "Below", "Above")


def in_a_slot(turning: bool, **options: object) -> stiv.EditSession:
    """Rigid, with centre and rotation vector as controls; or scaled, with centre and factors."""
    parts = [BOX, PLATE.moved((0, 0, -0.5 - GAP)), PLATE.moved((0, 0, 0.5 + GAP))]
    start = np.vstack([part.vertices for part in parts])
    begin = np.cumsum([0, *(len(part.vertices) for part in parts)])
    triangles = np.vstack([part.triangles() + first for part, first in zip(parts, begin, strict=False)])
    kinds = ["rigid" if turning else "deformable", "fixed", "fixed"]
    surface = stiv.Surface(
        triangles,
        len(start),
        vertex_body=np.repeat(np.arange(3), np.diff(begin)),
        bodies=[stiv.Body(name, kind) for name, kind in zip(NAMES, kinds, strict=True)],
    )
    if turning:
        moved, controls = stiv.rigid(BOX.vertices), stiv.rigid_rest_controls(BOX.vertices)
    else:
        moved, controls = stiv.scaling(BOX.vertices, np.eye(3)), stiv.scaling_rest_controls(BOX.vertices)
    deformation = stiv.concatenate([(moved, np.arange(begin[1]))], start)
    return stiv.EditSession(surface, deformation, controls, stiv.EditOptions(**options))


@pytest.mark.parametrize("turning", [True, False])
def test_a_squeezed_box_stops_at_the_last_clear_state(turning):
    session = in_a_slot(turning)
    goal = session.controls
    goal[1] = (0.8, 0, 0) if turning else (3, 3, 3)
    result = session.edit(goal)
    heights = result.surface[: len(BOX.vertices), 2]
    assert result.status in ("corrected", "blocked")
    assert len(stiv.find_intersections(result.surface, session._topology)) == 0
    assert heights.min() > -0.5 - GAP and heights.max() < 0.5 + GAP
    assert heights.max() - heights.min() > 1 + GAP  # it moved as far as possible and stayed there


@pytest.mark.parametrize("turning", [True, False])
def test_a_box_that_cannot_yield_is_blocked_and_names_the_obstacle(turning):
    session = in_a_slot(turning, weights=np.zeros(2))
    before = session.surface
    goal = session.controls
    goal[1] = (0.8, 0, 0) if turning else (3, 3, 3)
    result = session.edit(goal)
    assert result.status == "blocked"
    assert set(result.blocking) == set(NAMES)
    assert len(stiv.find_intersections(result.surface, session._topology)) == 0
    assert np.array_equal(result.surface[len(BOX.vertices) :], before[len(BOX.vertices) :])
