# SPDX-License-Identifier: GPL-3.0-or-later
"""A target to snap to: a quad, whose face is hit by arithmetic of its own."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np

from stiv_addon.transform.snap_search import SnapSearch
from stiv_addon.transform.snapping import Snap

CORNERS = np.array([[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.0]])
BELOW = CORNERS - [0.0, 0.0, 3.0]


@dataclass
class Quad:
    """A horizontal quad."""

    corners: np.ndarray = field(default_factory=lambda: CORNERS)
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))
    surface: bool = True
    upwards: bool = True

    def __post_init__(self) -> None:
        self.low, self.high = self.corners.min(axis=0), self.corners.max(axis=0)
        loop = np.arange(4)
        edges = np.stack([loop, (loop + 1) % 4], axis=1)
        order = loop if self.upwards else loop[::-1]
        edge_order = loop if self.upwards else np.array([2, 1, 0, 3])
        self.mesh = SimpleNamespace(
            vertices=self.corners, edges=edges, corner_vertices=order, corner_edges=edge_order, starts=np.array([0, 4]),
            loose=np.empty(0, int), vertex_normal=lambda vertex: np.array([0.0, 0.0, 1.0 if self.upwards else -1.0]),
        )  # fmt: skip

    def cast(self, origin: np.ndarray, direction: np.ndarray) -> tuple | None:
        length = (self.low[2] - origin[2]) / direction[2] if direction[2] else -1.0
        place = origin + length * direction
        inside = (self.low[:2] <= place[:2]).all() and (place[:2] <= self.high[:2]).all()
        normal = np.array([0.0, 0.0, 1.0 if self.upwards else -1.0])
        return (place, normal, 0) if length > 0.0 and inside else None

    def closest(self, point: np.ndarray) -> np.ndarray:
        return np.clip(point, self.low, self.high)


def searching(*quads: Quad, **chosen: object) -> object:
    """The field `search` of a Snap."""
    return lambda elements: SnapSearch(quads or (Quad(),), elements, **chosen)


def snapping(*elements: str, **chosen: object) -> Snap:
    """Snapping to a quad."""
    return Snap(frozenset(elements), **({"search": searching(), "search_base": searching()} | chosen))
