# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that touch each other, for the tests of contacts without sessions."""

from typing import Any

import numpy as np

import stiv
from blend_fixtures.scenes.primitives import box, grid, triangulated
from blend_fixtures.scenes.shape import joined

CUBE = triangulated(box(2))


def scene(moving: Any, *others: Any) -> tuple[stiv.Surface, np.ndarray, np.ndarray]:
    """A body that moves, and others that do not, with coordinates in single precision."""
    whole = joined([moving, *others])
    owner = np.repeat(range(1 + len(others)), [len(each.vertices) for each in (moving, *others)])
    bodies = [stiv.Body("moving", "rigid"), *(stiv.Body(f"rest {k}", "fixed") for k in range(len(others)))]
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    return surface, whole.vertices.astype(np.float32).astype(float), owner == 0


def flat(size: float, *place: float) -> Any:
    """A square of this width, whose normal points up."""
    return triangulated(grid(3, 3, size, size)).moved(place)
