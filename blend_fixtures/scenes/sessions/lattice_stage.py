# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions with a lattice, with the shapes and steps of the fixture that is written as a .blend."""

from __future__ import annotations

import numpy as np

import stiv

from ..fixture import Fixture
from ..motion import Step
from .session import Edit, Stage, moved, scaled, surface_of


def edit_of(step: Step) -> Edit:
    """The edit of a step on all points of the lattice."""
    value = step["values"]["value"]
    return moved(value) if step["operator"] == "move" else scaled(value)


def lattice_stage(fixture: Fixture) -> Stage:
    """The fixture's lattice with its meshes; all other meshes are obstacles."""
    (grid,) = fixture.lattices
    shapes = {mesh.name: mesh.shape for mesh in fixture.meshes}
    mobility = {mesh.name: "fixed" for mesh in fixture.meshes if not mesh.lattice}
    surface, start = surface_of(shapes, mobility)
    frame = grid.placement.matrix()
    moves = np.flatnonzero(np.isin(surface.vertex_body, [k for k, m in enumerate(fixture.meshes) if m.lattice]))
    weights = stiv.lattice(start[moves], grid.resolution, frame=frame)
    points = stiv.lattice_rest_points(grid.resolution) @ frame[:3, :3].T + frame[:3, 3]
    edits = tuple(edit_of(step) for step in fixture.steps for _ in range(step.get("repeat", 1)))
    return Stage(fixture.name, surface, stiv.concatenate([(weights, moves)], start), points, edits)
