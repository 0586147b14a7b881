# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterizes triangles with NumPy: orthographic, flat shading, a depth buffer. Needs no display."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_AT_ONCE = 2**21  # pixels that are tested at once


@dataclass(frozen=True)
class Camera:
    """An orthographic view. The rows of `axes` point right, up and toward the eye. `height` in world units."""

    axes: Floats  #: (3, 3)
    centre: Floats  #: (3,)
    height: float

    def seen(self, points: Floats, size: tuple[int, int]) -> Floats:
        """Column, row and inverse depth of points, (n, 3), in an image of this width and height."""
        width, height = size
        right, up, near = ((points - self.centre) @ self.axes.T).T
        scale = height / self.height
        return np.column_stack([width / 2 + right * scale, height / 2 - up * scale, near])


def camera_at(points: Floats, direction: Floats, margin: float = 1.15, aspect: float = 1.0) -> Camera:
    """A camera that looks along -`direction` and sees all points, (n, 3)."""
    toward = direction / np.linalg.norm(direction)
    helper = np.array([0.0, 0.0, 1.0]) if abs(toward[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(helper, toward)
    right /= np.linalg.norm(right)
    axes = np.array([right, np.cross(toward, right), toward])
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    extent = high - low
    height = margin * max(float(extent[1]), float(extent[0]) / aspect, 1e-6 * float(np.abs(points).max(initial=1e-30)))
    return Camera(axes, (low + high) / 2 @ axes, height)


def draw(
    positions: Floats, triangles: NDArray[np.int32], colors: Floats, camera: Camera, size: tuple[int, int]
) -> tuple[Floats, Floats]:
    """Draws triangles: the image, (height, width, 3) in [0, 1], and the inverse depth of each pixel.

    colors: (F, 3), before shading. The background is white, with inverse depth -inf.
    """
    width, height = size
    corners = camera.seen(positions, size)[triangles]
    shaded = colors * _shade(positions[triangles], camera)[:, None]
    image, depth = np.ones((height * width, 3)), np.full(height * width, -np.inf)
    low = np.maximum(np.floor(corners[:, :, :2].min(axis=1)), 0).astype(np.int64)
    high = np.minimum(np.ceil(corners[:, :, :2].max(axis=1)), [width, height]).astype(np.int64)
    extent = np.maximum(high - low, 0).max(axis=1)
    visible = (high > low).all(axis=1)
    side = 2
    while True:  # triangles of similar size together, each in a square of pixels
        chosen = np.flatnonzero(visible & (extent <= side) & (extent > (0 if side == 2 else side // 2)))
        for batch in np.array_split(chosen, max(1, -(-len(chosen) * side * side // _AT_ONCE))):
            _fill(image, depth, corners[batch], shaded[batch], low[batch], side, size)
        if side >= max(size):
            return image.reshape(height, width, 3), depth.reshape(height, width)
        side *= 2


def _fill(
    image: Floats, depth: Floats, corners: Floats, colors: Floats, low: NDArray[np.int64], side: int,
    size: tuple[int, int],
) -> None:  # fmt: skip
    if len(corners) == 0:
        return
    width, height = size
    rows, columns = np.divmod(np.arange(side * side), side)
    x, y = low[:, :1] + columns, low[:, 1:] + rows  # (k, side * side) pixels
    a, b, c = (corners[:, k, :, None] for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        u = ((b[:, 0] - x - 0.5) * (c[:, 1] - y - 0.5) - (c[:, 0] - x - 0.5) * (b[:, 1] - y - 0.5)) / area
        v = ((c[:, 0] - x - 0.5) * (a[:, 1] - y - 0.5) - (a[:, 0] - x - 0.5) * (c[:, 1] - y - 0.5)) / area
    w = 1 - u - v
    inside = (u >= 0) & (v >= 0) & (w >= 0) & (x < width) & (y < height)
    near = (u * a[:, 2] + v * b[:, 2] + w * c[:, 2])[inside]
    pixel = (y * width + x)[inside]
    color = np.broadcast_to(colors[:, None, :], (*inside.shape, 3))[inside]
    order = np.argsort(near, kind="stable")  # the last write to a pixel, the nearest, wins
    pixel, near, color = pixel[order], near[order], color[order]
    nearer = near > depth[pixel]
    depth[pixel[nearer]], image[pixel[nearer]] = near[nearer], color[nearer]


def _shade(corners: Floats, camera: Camera) -> Floats:
    """Brightness of triangles, (F,), the same on both sides. The light comes from above the eye."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    light = np.array([0.25, 0.45, 0.86]) @ camera.axes
    facing: Floats = np.abs(normals @ light) / np.where(length > 0, length, 1)
    return 0.4 + 0.6 * facing
