# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes moved by handles in a session: fixed vertices stay exactly in place, and nothing intersects."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from benchmarks.knot import drag_knot
from blend_fixtures.scenes import families


def test_the_knot_is_dragged_tight_without_intersecting_itself() -> None:
    result = drag_knot(rings=90, sides=6, moves=12)
    assert result.intersections == 0
    assert result.moves_with_contact > 0
    assert result.foot_motion == 0
    assert result.travel > 0.5 * result.asked


@pytest.mark.parametrize("edit", [families.bulge(0.8), families.bulge(0.8, cells=10, rigid=True)], ids=lambda e: e.name)
def test_pinned_handles_and_fixed_vertices_do_not_move_at_all(edit: families.Edit) -> None:
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(**edit.options))
    pinned = np.asarray(edit.options["weights"]) == 0
    moved = {vertex for control in range(len(pinned)) for vertex in edit.deformation.support(control)}
    still = np.setdiff1d(np.arange(len(session.surface)), sorted(moved))
    assert len(still) > 0
    start = session.surface
    chance = np.random.default_rng(3)
    for _ in range(6):
        goal = session.controls + 0.2 * chance.normal(size=session.controls.shape)
        goal[pinned] = session.controls[pinned]
        goal[~pinned] += 0.5 * (edit.goal - session.controls)[~pinned]
        result = session.edit(goal)
        assert len(stiv.find_intersections(result.surface, edit.surface)) == 0
        assert result.controls[pinned].tobytes() == edit.controls[pinned].astype(np.float32).astype(float).tobytes()
        assert result.surface[still].tobytes() == start[still].tobytes()
