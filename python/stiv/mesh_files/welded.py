# SPDX-License-Identifier: GPL-3.0-or-later
"""Welds meshes of polygons."""

from __future__ import annotations

import numpy as np

from stiv.mesh_files.mesh import Mesh, polygon_mesh
from stiv.surface import Surface
from stiv.welding import weld


def welded_mesh(mesh: Mesh) -> Mesh:
    """Merges vertices at exactly the same position, and corners of polygons with the same vertex.

    Removes polygons with fewer than three corners left, and duplicates.
    """
    points = weld(Surface(np.empty((0, 3), np.int32), len(mesh.vertices)), mesh.vertices)
    corners, counts, owners = [], [], []
    seen = set()
    for polygon, owner in zip(
        np.split(points.vertex_map[mesh.corners], np.cumsum(mesh.counts)[:-1]), mesh.polygon_object, strict=False
    ):
        kept = polygon[polygon != np.roll(polygon, 1)]
        key = tuple(sorted(kept.tolist()))
        if len(kept) >= 3 and key not in seen:
            seen.add(key)
            corners.append(kept)
            counts.append(len(kept))
            owners.append(int(owner))
    return polygon_mesh(
        points.positions,
        np.concatenate([np.empty(0, np.int64), *corners]),
        np.array(counts, np.int64),
        mesh.object_names,
        np.array(owners, np.int64),
    )
