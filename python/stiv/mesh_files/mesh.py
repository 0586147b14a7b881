# SPDX-License-Identifier: GPL-3.0-or-later
"""The checked contents of a mesh file."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stiv import InputError


@dataclass(frozen=True)
class Mesh:
    """Polygons and their triangles, with the object of each."""

    vertices: NDArray[np.float64]  # (N, 3)
    triangles: NDArray[np.int32]  # (F, 3)
    object_names: tuple[str, ...]
    triangle_object: NDArray[np.int32]  # (F,) index into object_names
    corners: NDArray[np.int32]  # (C,) vertices of all polygons, polygon by polygon
    counts: NDArray[np.int32]  # (P,) number of corners of each polygon
    polygon_object: NDArray[np.int32]  # (P,) index into object_names


def checked_mesh(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    object_names: tuple[str, ...],
    triangle_object: NDArray[np.int64] | None = None,
) -> Mesh:
    """A mesh of triangles whose coordinates are finite and whose indices are in range.

    Raises InputError naming the element.
    """
    owner = np.zeros(len(triangles), np.int64) if triangle_object is None else triangle_object
    if owner.shape != (len(triangles),) or (len(owner) and not 0 <= owner.min() <= owner.max() < len(object_names)):
        raise InputError("the objects of triangles do not match the triangles and the object names")
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise InputError(f"vertex {int(np.argmin(finite))}: coordinate is not finite")
    inside = ((triangles >= 0) & (triangles < len(vertices))).all(axis=1)
    if not inside.all():
        first = int(np.argmin(inside))
        corners = triangles[first].tolist()
        raise InputError(f"triangle {first}: index out of range in {corners}; there are {len(vertices)} vertices")
    kept, owners = triangles.astype(np.int32), owner.astype(np.int32)
    return Mesh(vertices, kept, object_names, owners, kept.ravel(), np.full(len(kept), 3, np.int32), owners)


def polygon_mesh(
    vertices: NDArray[np.float64],
    corners: NDArray[np.int64],
    counts: NDArray[np.int64],
    object_names: tuple[str, ...],
    polygon_object: NDArray[np.int64] | None = None,
) -> Mesh:
    """A mesh of polygons, triangulated as fans, and checked like `checked_mesh`."""
    owner = np.zeros(len(counts), np.int64) if polygon_object is None else polygon_object
    triangle_object = np.repeat(owner, np.maximum(counts - 2, 0))
    mesh = checked_mesh(vertices, fans(corners, counts), object_names, triangle_object)
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(vertices):  # corners of faces without triangles
        raise InputError(f"face index out of range; there are {len(vertices)} vertices")
    polygons = (corners.astype(np.int32), counts.astype(np.int32), owner.astype(np.int32))
    return replace(mesh, corners=polygons[0], counts=polygons[1], polygon_object=polygons[2])


def fans(corners: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangulates polygons as fans from their first corner: (F, 3). `counts`: (P,), corners of each polygon."""
    starts = np.cumsum(counts) - counts
    cuts = np.maximum(counts - 2, 0)
    start = np.repeat(starts, cuts)
    within = np.arange(cuts.sum()) - np.repeat(np.cumsum(cuts) - cuts, cuts)
    return np.stack([corners[start], corners[start + within + 1], corners[start + within + 2]], axis=1).reshape(-1, 3)
