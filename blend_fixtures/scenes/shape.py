# SPDX-License-Identifier: GPL-3.0-or-later
"""A shape: only vertices and polygons, with the operations that builders need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Faces = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Shape:
    """Vertices (N, 3) in float64 and faces as vertex indices, counter-clockwise seen from outside."""

    vertices: NDArray[np.float64]
    faces: Faces

    def moved(self, offset: ArrayLike) -> Shape:
        """The shape translated by `offset` (3,)."""
        return Shape(self.vertices + np.asarray(offset, float), self.faces)

    def scaled(self, factors: ArrayLike) -> Shape:
        """The shape scaled about the origin by `factors`, a number or (3,)."""
        return Shape(self.vertices * np.asarray(factors, float), self.faces)

    def turned(self, angles: ArrayLike) -> Shape:
        """The shape rotated about the origin by XYZ Euler angles (3,) in radians."""
        return Shape(self.vertices @ rotation_matrix(angles).T, self.faces)

    def triangles(self) -> NDArray[np.int32]:
        """Fans of the faces from their first corner, (F, 3)."""
        fans = [(face[0], face[i], face[i + 1]) for face in self.faces for i in range(1, len(face) - 1)]
        return np.array(fans, np.int32).reshape(-1, 3)


def joined(shapes: Sequence[Shape]) -> Shape:
    """One shape made of several, with vertices and faces in the given order."""
    faces: list[tuple[int, ...]] = []
    start = 0
    for shape in shapes:
        faces += [tuple(i + start for i in face) for face in shape.faces]
        start += len(shape.vertices)
    return Shape(np.concatenate([shape.vertices for shape in shapes]), tuple(faces))


def rotation_matrix(angles: ArrayLike) -> NDArray[np.float64]:
    """Rotation (3, 3) of XYZ Euler angles in radians: first about x, then y, then z, as Blender orders them."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    rotation: NDArray[np.float64] = about_z @ about_y @ about_x
    return rotation
