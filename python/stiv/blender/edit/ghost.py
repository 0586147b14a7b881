# SPDX-License-Identifier: GPL-3.0-or-later
"""The goal of an edit as a ghost, for the overlay."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

import stiv
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.scene.arrays import Floats, Indices, transform_points

MAX_TRIANGLES = 20000  # larger objects are shown as a box, which costs nothing
MAX_VERTICES = 40000  # of the whole surface, which a goal evaluates
LEAST_OFFSET = 0.01  # a goal closer than this to the surface shown has no ghost, relative to the size
AT_GOAL = frozenset({"reached", "unchanged", "unguarded"})

_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float64)
_EDGES = np.array(
    [[a, b] for a in range(8) for b in range(a) if np.abs(_CORNERS[a] - _CORNERS[b]).sum() == 1], np.int32
)


@dataclass(frozen=True)
class Ghost:
    """The moved objects at their goal.

    Attributes:
        points: (n, 3) positions.
        triangles: (t, 3) indices of points; empty if the objects are shown as a box.
        edges: (e, 2) of the box.
    """

    points: Floats
    triangles: Indices = field(default_factory=lambda: np.empty((0, 3), np.int32))
    edges: Indices = field(default_factory=lambda: np.empty((0, 2), np.int32))


class GhostSource:
    """Ghosts of one edit; the triangles are chosen once."""

    def __init__(self, edit: BlenderEdit) -> None:
        self._edit = edit
        self._assembly = edit.assembly

    def belongs_to(self, edit: BlenderEdit) -> bool:
        """Whether the ghosts are those of this edit, with its present triangles."""
        return self._edit is edit and self._assembly is edit.assembly

    def ghost(self, result: stiv.EditResult, matrix: Floats | None = None) -> Ghost | None:
        """The ghost of the present goal; None if the result is there.

        matrix: (4, 4) world motion of the moved objects as a whole; None if they have several or only parts move. Then
        large objects have no ghost.
        """
        vertices, triangles = self._moved
        if result.status in AT_GOAL or not len(vertices):
            return None
        if len(triangles) > MAX_TRIANGLES or len(self._assembly.positions) > MAX_VERTICES:
            return None if matrix is None else Ghost(transform_points(matrix, self._box), edges=_EDGES)
        goal, present = self._edit.surface_of(self._edit.goal)[vertices], result.surface[vertices]
        if np.abs(goal - present).max() <= LEAST_OFFSET * np.ptp(goal, axis=0).max():
            return None
        return Ghost(goal, triangles)

    @cached_property
    def _box(self) -> Floats:
        """Corners, (8, 3), of the box around the moved objects at the start."""
        points = self._assembly.positions[self._moved[0]]
        low, high = points.min(axis=0), points.max(axis=0)
        return np.asarray(low + _CORNERS * (high - low), np.float64)

    @cached_property
    def _moved(self) -> tuple[Indices, Indices]:
        """Vertices of the objects that the transform moves, (n,), and their triangles with numbers among these."""
        moving = self._edit.moving
        chosen = [k for k, mesh in enumerate(self._assembly.meshes) if mesh.owner.name in moving]
        if not chosen:
            return np.empty(0, np.int32), np.empty((0, 3), np.int32)
        vertices = self._assembly.vertices_of(chosen)
        numbers = np.full(len(self._assembly.positions), -1, np.int32)
        numbers[vertices] = np.arange(len(vertices), dtype=np.int32)
        triangles = numbers[self._assembly.surface.triangles]
        return vertices, triangles[(triangles >= 0).all(axis=1)]
