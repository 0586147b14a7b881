# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether Blender certainly splits each quad of a mesh along its first diagonal, from the positions alone.

Blender takes the other diagonal only if the halves along the first one face away from each other. To read its
triangulation takes several times longer than this test.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stiv.blender.scene.arrays import Indices, Singles
from stiv.blender.scene.evaluated_scene import VisibleMesh

CLEAR = 1e-3  # cosine of the angle between the halves above which rounding cannot decide


@dataclass(frozen=True)
class QuadDiagonals:
    """Corners of quads, (4, k), in the order of the face. Quads whose two triangulations are known are left out."""

    corners: Indices

    @staticmethod
    def of(mesh: VisibleMesh) -> QuadDiagonals | None:
        """The quads of a mesh; None if it has larger faces, or quads that are split along the second diagonal."""
        first_of_second = np.flatnonzero(np.diff(mesh.faces) < 0)  # where the second triangulations begin
        count = int(first_of_second[0]) + 1 if len(first_of_second) else len(mesh.faces)
        faces, triangles = mesh.faces[:count], mesh.triangles[:count]
        sizes = np.bincount(faces) if count else np.empty(0, int)
        if (sizes > 2).any():
            return None
        rows = np.flatnonzero(faces[:-1] == faces[1:])
        rows = rows[~np.isin(faces[rows], mesh.faces[count:])]
        a, b = triangles[rows].T, triangles[rows + 1].T
        if not (np.array_equal(a[0], b[0]) and np.array_equal(a[2], b[1])):
            return None
        return QuadDiagonals(np.ascontiguousarray([a[0], a[1], a[2], b[2]]))

    def are_kept(self, local: Singles) -> bool:
        """Is every quad split along its first diagonal at these positions, (n, 3)?"""
        columns = np.ascontiguousarray(local.T)
        one, two = self._normals(columns)
        dots = _dot(one, two)
        lengths = _dot(one, one) * _dot(two, two)
        return bool(((dots > 0) & (dots * dots > CLEAR**2 * lengths)).all())

    def _normals(self, columns: Singles) -> tuple[list[Singles], list[Singles]]:
        """Normals of both halves, as columns."""
        start, *others = ([axis[corner] for axis in columns] for corner in self.corners)
        side, diagonal, last = ([x - y for x, y in zip(each, start, strict=True)] for each in others)
        return _cross(side, diagonal), _cross(diagonal, last)


def _dot(a: list[Singles], b: list[Singles]) -> Singles:
    dots: Singles = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return dots


def _cross(a: list[Singles], b: list[Singles]) -> list[Singles]:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
