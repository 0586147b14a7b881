# SPDX-License-Identifier: GPL-3.0-or-later
"""The projection of a 3D view: between pixels of its region and world positions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Pixel = tuple[float, float]


@dataclass(frozen=True)
class View:
    """A view in perspective or parallel projection.

    Attributes:
        projection: (4, 4) from homogeneous world coordinates to clip space (Blender's `perspective_matrix`).
        size: width and height of the region in pixels.

    """

    projection: Vector
    size: tuple[int, int]

    def project(self, point: Vector) -> Pixel | None:
        """The pixel of a world position, None for one behind the viewer."""
        clip = self._clip(point)
        if clip[3] <= 0.0:
            return None
        x, y = clip[:2] / clip[3]
        return float((x + 1.0) / 2.0 * self.size[0]), float((y + 1.0) / 2.0 * self.size[1])

    def unproject(self, pixel: Pixel, depth: float) -> Vector:
        """The world position at a pixel and a normalised depth in (-1, 1)."""
        x, y = 2.0 * pixel[0] / self.size[0] - 1.0, 2.0 * pixel[1] / self.size[1] - 1.0
        point = _inverse(np.asarray(self.projection, np.float64).tobytes()) @ np.array([x, y, depth, 1.0])
        return np.asarray(point[:3] / point[3])

    def at_depth_of(self, pixel: Pixel, reference: Vector) -> Vector:
        """The world position at a pixel, at the depth of `reference`."""
        clip = self._clip(reference)
        return self.unproject(pixel, float(clip[2] / clip[3]) if clip[3] > 0.0 else 0.0)

    def ray(self, pixel: Pixel, reference: Vector) -> tuple[Vector, Vector]:
        """The view ray of a pixel: its point at the depth of `reference`, and the unit direction from the viewer."""
        along = self.unproject(pixel, 1.0) - self.unproject(pixel, -1.0)
        return self.at_depth_of(pixel, reference), along / np.linalg.norm(along)

    def segment(self, pixel: Pixel) -> tuple[Vector, Vector]:
        """Where the view ray of a pixel starts, and its unit direction from the viewer."""
        origin = self.unproject(pixel, -1.0)
        along = self.unproject(pixel, 1.0) - origin
        return origin, along / np.linalg.norm(along)

    @property
    def backward(self) -> Vector:
        """Unit direction against which the view looks: the view's z axis."""
        away = -self.projection[3, :3]  # zero in a parallel projection
        if not away.any():
            return -self.segment((self.size[0] / 2.0, self.size[1] / 2.0))[1]
        return np.asarray(away / np.linalg.norm(away))

    @property
    def right(self) -> Vector:
        """Unit direction to the right: the view's x axis."""
        across = self.projection[0, :3] - self.backward * (self.projection[0, :3] @ self.backward)
        return np.asarray(across / np.linalg.norm(across))

    @property
    def looks_along_axis(self) -> bool:
        """Whether this is a parallel view along an axis of the world."""
        return not self.projection[3, :3].any() and bool(np.abs(self.backward).max() > 1.0 - 1e-6)

    def shows(self, point: Vector) -> bool:
        """Whether a world position is between the near and the far end of the view."""
        clip = self._clip(point)
        return bool(abs(clip[2]) < clip[3])

    def toward_viewer(self, point: Vector) -> Vector:
        """Unit direction from a world position to the viewer."""
        pixel = self.project(point) or (self.size[0] / 2.0, self.size[1] / 2.0)
        return -self.ray(pixel, point)[1]

    def _clip(self, point: Vector) -> Vector:
        return np.asarray(self.projection @ np.append(point, 1.0))


@lru_cache(maxsize=8)
def _inverse(projection: bytes) -> Vector:
    """Inverse of a projection, (4, 4). To solve at each motion would wake the threads of NumPy's BLAS, which spin."""
    return np.asarray(np.linalg.inv(np.frombuffer(projection).reshape(4, 4)))
