# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh file holds, checked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stiv import InputError


@dataclass(frozen=True)
class Mesh:
    """Triangles with the objects they belong to."""

    vertices: NDArray[np.float64]  # (N, 3)
    triangles: NDArray[np.int32]  # (F, 3)
    object_names: tuple[str, ...]
    triangle_object: NDArray[np.int32]  # (F,) index into object_names


def checked_mesh(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    object_names: tuple[str, ...],
    triangle_object: NDArray[np.int64] | None = None,
) -> Mesh:
    """A mesh whose coordinates are finite and whose indices are in range. Raises InputError naming the element."""
    owner = np.zeros(len(triangles), np.int64) if triangle_object is None else triangle_object
    if owner.shape != (len(triangles),) or (len(owner) and not 0 <= owner.min() <= owner.max() < len(object_names)):
        raise InputError("the objects that triangles belong to do not fit the triangles and the object names")
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise InputError(f"vertex {int(np.argmin(finite))}: coordinate is not finite")
    inside = ((triangles >= 0) & (triangles < len(vertices))).all(axis=1)
    if not inside.all():
        first = int(np.argmin(inside))
        corners = triangles[first].tolist()
        raise InputError(f"triangle {first}: index out of range in {corners}; there are {len(vertices)} vertices")
    return Mesh(vertices, triangles.astype(np.int32), object_names, owner.astype(np.int32))


def fans(corners: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Polygons cut into fans from their first corner: (F, 3). `corners` lie behind one another, `counts` (P,) each."""
    starts = np.cumsum(counts) - counts
    cuts = np.maximum(counts - 2, 0)
    start = np.repeat(starts, cuts)
    within = np.arange(cuts.sum()) - np.repeat(np.cumsum(cuts) - cuts, cuts)
    return np.stack([corners[start], corners[start + within + 1], corners[start + within + 2]], axis=1).reshape(-1, 3)
