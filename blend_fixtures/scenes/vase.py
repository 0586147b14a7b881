# SPDX-License-Identifier: GPL-3.0-or-later
"""A thick-walled vase: wide belly, narrow neck, flared lip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .shape import Shape
from .sweeps import revolution

HEIGHT = 1.6
NECK_HEIGHT = 1.22
WALL = 0.05

# Radius of the inner wall over height, from the floor to the lip, as knots of a smooth curve.
_INNER_HEIGHTS = np.array([0.06, 0.10, 0.25, 0.50, 0.80, 1.05, 1.22, 1.38, 1.50, 1.585])
_INNER_RADII = np.array([0.30, 0.37, 0.47, 0.54, 0.49, 0.39, 0.355, 0.40, 0.50, 0.62])


def inner_radius(height: float) -> float:
    """Inner radius of the vase at a height above its foot."""
    return float(_smooth(np.array([height]))[0])


def _smooth(heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """The Catmull-Rom curve of the knots (Hermite with central differences), smooth at uneven knots."""
    slopes = np.gradient(_INNER_RADII, _INNER_HEIGHTS)
    i = np.clip(np.searchsorted(_INNER_HEIGHTS, heights) - 1, 0, len(slopes) - 2)
    width = _INNER_HEIGHTS[i + 1] - _INNER_HEIGHTS[i]
    t = np.clip((heights - _INNER_HEIGHTS[i]) / width, 0, 1)
    start = (1 + 2 * t) * (1 - t) ** 2 * _INNER_RADII[i] + t * (1 - t) ** 2 * width * slopes[i]
    end = t**2 * (3 - 2 * t) * _INNER_RADII[i + 1] + t**2 * (t - 1) * width * slopes[i + 1]
    return start + end


def profile(rings: int) -> NDArray[np.float64]:
    """Closed profile (rings + 2, 2) of radius and height, from the centre of the foot to the centre of the floor."""
    outer_count = (rings - 8) // 2
    inner_count = rings - 8 - outer_count
    outer_heights = np.linspace(0.02, HEIGHT - 0.01, outer_count)
    outer = np.stack([_smooth(np.maximum(outer_heights, _INNER_HEIGHTS[0])) + WALL, outer_heights], 1)
    inner_heights = np.linspace(HEIGHT - 0.015, 0.07, inner_count)
    inner = np.stack([_smooth(inner_heights), inner_heights], 1)
    foot = np.array([[0.0, 0.03], [0.12, 0.03], [0.22, 0.02], [0.27, 0.0], [0.33, 0.0]])
    lip = np.array([[inner[0, 0] + 0.035, HEIGHT + 0.005], [inner[0, 0] + 0.015, HEIGHT + 0.003]])
    floor = np.array([[0.20, 0.062], [0.10, 0.06], [0.0, 0.06]])
    return np.concatenate([foot, outer, lip, inner, floor])


def vase(sides: int = 34, rings: int = 44) -> Shape:
    """A closed solid vase standing on z = 0, with sides x rings + 2 vertices and outward faces."""
    closed = profile(rings)
    assert len(closed) == rings + 2
    return revolution(closed, sides)
