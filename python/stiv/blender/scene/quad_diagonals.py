# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether Blender certainly splits each quad of a mesh along its first diagonal, from the positions alone.

Blender takes the other diagonal only if the halves along the first one face away from each other. To read its
triangulation takes several times longer than this test.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Indices, Singles
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.points import find_folded

CLEAR = 1e-3  # cosine of the angle between the halves above which rounding cannot decide
# Height of a half above the diagonal, in the largest coordinate, above which it cannot either: where Blender knows the
# normals of faces, it compares products with coordinates.
NARROW = 2.0**-18


@dataclass(frozen=True)
class QuadDiagonals:
    """The quads of a mesh of which one triangulation is known.

    Attributes:
        corners: (4, k), in the order of the face. The first diagonal connects the first corner and the third.
        second: (k,), whether the known triangulation has the second diagonal.
    """

    corners: Indices
    second: NDArray[np.bool_]

    @staticmethod
    def of(mesh: VisibleMesh) -> QuadDiagonals | None:
        """The quads of a mesh; None if it has larger faces. Quads whose two triangulations are known are left out."""
        if not (mesh.faces[:-1] == mesh.faces[1:]).any():  # all faces are triangles
            return QuadDiagonals(np.empty((4, 0), np.int32), np.empty(0, np.bool_))
        first_of_second = np.flatnonzero(np.diff(mesh.faces) < 0)  # where the second triangulations begin
        count = int(first_of_second[0]) + 1 if len(first_of_second) else len(mesh.faces)
        faces, triangles = mesh.faces[:count], mesh.triangles[:count]
        sizes = np.bincount(faces) if count else np.empty(0, int)
        if (sizes > 2).any():
            return None
        rows = np.flatnonzero(faces[:-1] == faces[1:])
        rows = rows[~np.isin(faces[rows], mesh.faces[count:])]
        a, b = triangles[rows].T, triangles[rows + 1].T
        first, second = (a[0] == b[0]) & (a[2] == b[1]), (a[1] == b[0]) & (a[2] == b[2])
        if not (first ^ second).all():
            return None
        return QuadDiagonals(np.ascontiguousarray([a[0], a[1], np.where(second, b[1], a[2]), b[2]]), second)

    def find_uncertain(self, local: Singles) -> Indices:
        """The quads, (u,), that Blender may split along the diagonal that is not known, at these positions, (n, 3)."""
        folded = find_folded(local, self.corners, CLEAR, NARROW)
        return np.union1d(folded, np.flatnonzero(self.second)).astype(np.int32) if self.second.any() else folded

    def find_bent(self, local: Singles, cosine: float) -> Indices:
        """The quads whose halves along the first diagonal have a smaller cosine of the angle between their normals."""
        return find_folded(local, self.corners, cosine, NARROW)

    def other_triangles(self, quads: Indices) -> Indices:
        """The triangles, (2 u, 3), of quads split along the diagonal that is not known."""
        a, b, c, d = self.corners[:, quads]
        along_first = np.stack([a, b, c, a, c, d], axis=1)
        along_second = np.stack([a, b, d, b, c, d], axis=1)
        return np.where(self.second[quads][:, None], along_first, along_second).reshape(-1, 3)
