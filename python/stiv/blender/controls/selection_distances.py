# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from the selection, and islands of selected points."""

import heapq

import numpy as np
from mathutils.kdtree import KDTree
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Indices, islands

Mask = NDArray[np.bool_]


def nearest_distances(points: Floats, selected: Mask) -> Floats:
    """Distance of each point, (m, 3), from the nearest selected one, (m,); infinite if none is selected."""
    distances = np.where(selected, 0.0, np.inf)
    chosen = points[selected]
    if len(chosen) == 0:
        return distances
    tree = KDTree(len(chosen))
    for number, point in enumerate(chosen.tolist()):
        tree.insert(point, number)
    tree.balance()
    nearest = [tree.find(point)[1] for point in points[~selected].tolist()]
    # The tree is in single precision, so it only finds the nearest point.
    distances[~selected] = np.linalg.norm(points[~selected] - chosen[np.array(nearest, np.int64)], axis=1)
    return distances


def distances_along(edges: Indices, points: Floats, selected: Mask) -> Floats:
    """Length of the shortest path along edges, (e, 2), from a selected point, (m,); infinite without a path.

    (Dijkstra 1959.)
    """
    neighbors = _neighbors(edges, points)
    distances = np.where(selected, 0.0, np.inf)
    queue = [(0.0, int(index)) for index in np.flatnonzero(selected)]
    while queue:
        distance, index = heapq.heappop(queue)
        if distance > distances[index]:
            continue
        for other, length in neighbors[index]:
            if distance + length < distances[other]:
                distances[other] = distance + length
                heapq.heappush(queue, (distance + length, other))
    return distances


def island_centres(points: Floats, selected: Mask, edges: Indices | None) -> Floats:
    """For each selected point, (k,), the mean of its island of connected selected points, (k, 3).

    Without edges all selected points are one island.
    """
    chosen = np.flatnonzero(selected)
    inside = None if edges is None else edges[selected[edges].all(axis=1)]
    labels = np.zeros(len(points), np.int64) if inside is None else islands(len(points), inside)
    _, numbers = np.unique(labels[chosen], return_inverse=True)
    sums = np.zeros((numbers.max(initial=0) + 1, 3))
    np.add.at(sums, numbers, points[chosen])
    centres: Floats = (sums / np.bincount(numbers, minlength=len(sums))[:, None])[numbers]
    return centres


def _neighbors(edges: Indices, points: Floats) -> list[list[tuple[int, float]]]:
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    neighbors: list[list[tuple[int, float]]] = [[] for _ in points]
    for (a, b), length in zip(edges.tolist(), lengths.tolist(), strict=True):
        neighbors[a].append((b, length))
        neighbors[b].append((a, length))
    return neighbors
