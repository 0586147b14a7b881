# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterised triangles against rays."""

import numpy as np

from stiv.checks.raster import camera_at, draw

SIZE = (40, 40)


def test_pixels_and_depths_are_those_of_rays():
    chance = np.random.default_rng(2)
    corners = chance.normal(size=(12, 3, 3))
    colors = chance.uniform(0.3, 1, size=(12, 3))
    camera = camera_at(corners.reshape(-1, 3), np.array([0.3, -1.0, 0.4]))
    image, depth = draw(corners.reshape(-1, 3), np.arange(36, dtype=np.int32).reshape(12, 3), colors, camera, SIZE)
    expected = np.array([[nearest(camera, corners, x, y) for x in range(40)] for y in range(40)])
    assert np.isfinite(expected).sum() > 200  # otherwise the picture is empty
    np.testing.assert_allclose(depth, expected, atol=1e-9)
    assert (image[np.isinf(depth)] == 1).all() and (image[np.isfinite(depth)] < 1).any(axis=-1).all()


def nearest(camera, corners, x, y):
    """Inverse depth of the first triangle on the ray through the pixel's centre, by intersecting its plane."""
    scale = SIZE[1] / camera.height
    right, up = (x + 0.5 - SIZE[0] / 2) / scale, (SIZE[1] / 2 - y - 0.5) / scale
    found = -np.inf
    for triangle in (corners - camera.centre) @ camera.axes.T:
        basis = np.column_stack([triangle[1] - triangle[0], triangle[2] - triangle[0], [0.0, 0.0, -1.0]])
        u, v, near = np.linalg.solve(basis, np.array([right, up, 0.0]) - triangle[0])
        if u >= 0 and v >= 0 and u + v <= 1:
            found = max(found, near)
    return found
