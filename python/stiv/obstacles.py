# SPDX-License-Identifier: GPL-3.0-or-later
"""Large bodies that never move, beside the surface of a session."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv.arrays import Floats, Indices, as_indices, as_reals


class Obstacle:
    """A body of any size that never moves. Sessions read only its triangles near their motion.

    Immutable; sessions can share it. It stores about 25 bytes for each triangle and vertex. Reading is fastest if
    neighboring triangles are near each other in their order, as in most meshes.

    vertices   (n, 3) world positions, length
    triangles  (f, 3) vertex indices; degenerate triangles with repeated corners are allowed
    name       of the object, in messages and results

    Raises InputError naming vertex or face: a coordinate that is not finite or out of range, an index out of range.
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, name: str = "obstacle") -> None:
        """Check and store the body."""
        positions, corners = as_reals(vertices, "vertices", (None, 3)), as_indices(triangles, "triangles", (None, 3))
        self.name, self.vertex_count, self.triangle_count = name, len(positions), len(corners)
        self.native = _native.Obstacle(name, positions, corners)

    @property
    def vertices(self) -> Floats:
        """World positions, (n, 3), read-only."""
        return np.asarray(self.native.positions)

    @property
    def triangles(self) -> Indices:
        """Vertex indices, (f, 3), read-only."""
        return np.asarray(self.native.triangles)

    def triangles_near(self, low: ArrayLike, high: ArrayLike) -> Indices:
        """Return the triangles, ascending, whose bounds touch the box from `low` to `high`, (3,) each."""
        found: Indices = self.native.triangles_near(as_reals(low, "low", (3,)), as_reals(high, "high", (3,)))
        return found
