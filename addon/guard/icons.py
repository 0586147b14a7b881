# SPDX-License-Identifier: GPL-3.0-or-later
"""The shields for the states of the guard, drawn here since Blender has no icons in green, amber and red."""

from __future__ import annotations

import bpy.utils.previews
import numpy as np
from numpy.typing import NDArray

SIZE = 64  # pixels
COLOURS = {"guarded": (0.22, 0.65, 0.3), "partial": (0.95, 0.66, 0.1), "intersecting": (0.87, 0.2, 0.18)}
SIGN = (1.0, 1.0, 1.0)
STROKE = 0.09  # half the width of the sign, in halves of the icon

_previews: bpy.utils.previews.ImagePreviewCollection | None = None


def icon(state: str) -> int:
    """The icon of a state ("guarded", "partial", "intersecting") as Blender's layouts take it."""
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    if state not in _previews:
        preview = _previews.new(state)
        preview.icon_size = preview.image_size = (SIZE, SIZE)
        preview.icon_pixels_float = preview.image_pixels_float = pixels(state).ravel().tolist()
    return int(_previews[state].icon_id)


def remove() -> None:
    """Free the icons."""
    global _previews
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
    _previews = None


def pixels(state: str) -> NDArray[np.float64]:
    """A shield with a check mark, a bar or a cross, (SIZE, SIZE, 4), from the lowest row."""
    y, x = (np.mgrid[0:SIZE, 0:SIZE] + 0.5) * (2.0 / SIZE) - 1.0
    half_width = np.where(y > 0, 0.78, 0.78 * np.sqrt(np.clip(1 - (y / 0.95) ** 2, 0, 1)))
    inside = (np.abs(x) < half_width) & (y < 0.85)
    picture = np.zeros((SIZE, SIZE, 4))
    picture[inside] = (*COLOURS[state], 1.0)
    picture[inside & _sign(state, x, y)] = (*SIGN, 1.0)
    return picture


def _sign(state: str, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
    if state == "guarded":
        return _is_near(x, y, (-0.4, 0.05), (-0.1, -0.3)) | _is_near(x, y, (-0.1, -0.3), (0.42, 0.42))
    if state == "partial":
        return _is_near(x, y, (0.0, 0.5), (0.0, -0.05)) | _is_near(x, y, (0.0, -0.42), (0.0, -0.4))
    return _is_near(x, y, (-0.34, 0.4), (0.34, -0.3)) | _is_near(x, y, (-0.34, -0.3), (0.34, 0.4))


def _is_near(
    x: NDArray[np.float64], y: NDArray[np.float64], start: tuple[float, float], end: tuple[float, float]
) -> NDArray[np.bool_]:
    """Which points are on a stroke."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    along = np.clip(((x - start[0]) * dx + (y - start[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    distance: NDArray[np.float64] = np.hypot(x - start[0] - along * dx, y - start[1] - along * dy)
    return distance < STROKE
