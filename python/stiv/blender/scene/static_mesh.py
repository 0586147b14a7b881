# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that stays as it is during an edit: an obstacle beside the surface, with lookup from it to elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices, Singles
from stiv.blender.scene.elements import Element
from stiv.blender.scene.evaluated_scene import CroppedMesh, VisibleMesh
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True, eq=False)
class StaticMesh:
    """One evaluated mesh, its placement in the world, and the obstacle made from both.

    The obstacle has the triangles of the mesh, then one with two corners for each loose edge, then one with one corner
    for each loose vertex.

    Attributes:
        owner: the object that shows it.
        source: name of the object whose data is shown.
        local: positions in its own frame as stored, (n, 3).
        matrix: frame to world, (4, 4).
        corners: vertex of each corner of all faces.
        starts: first corner of each face, then the number of corners, (F + 1,); None if all faces are triangles.
        loose_edges: (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        loose_vertices: vertices without edges, (k,).
        shown_in: the evaluations that show the mesh.
        obstacle: in the world.
    """

    owner: ObjectReference
    source: str
    local: Singles
    matrix: Floats
    corners: Indices
    starts: Indices | None
    loose_edges: Indices
    loose_numbers: Indices
    loose_vertices: Indices
    shown_in: frozenset[str]
    obstacle: stiv.Obstacle

    @property
    def triangle_count(self) -> int:
        """Number of triangles of the mesh."""
        return self.obstacle.triangle_count - len(self.loose_edges) - len(self.loose_vertices)

    def element(self, triangle: int) -> Element:
        """The element of a triangle of the obstacle."""
        kinds = self.elements(np.array([triangle], np.int32))
        return next(replace(kind, number=int(numbers[0])) for kind, numbers in kinds if len(numbers))

    def elements(self, triangles: Indices) -> tuple[tuple[Element, Indices], ...]:
        """The faces, edges and vertices of some triangles of the obstacle, ascending; each kind with its numbers."""
        edges, vertices = np.searchsorted(triangles, [self.triangle_count, self.triangle_count + len(self.loose_edges)])
        numbers = {
            "face": self._faces_of(triangles[:edges]),
            "edge": self.loose_numbers[triangles[edges:vertices] - self.triangle_count],
            "vertex": self.loose_vertices[triangles[vertices:] - self.triangle_count - len(self.loose_edges)],
        }
        return tuple((Element(self.owner.name, kind, 0), own) for kind, own in numbers.items())

    def cropped(self, near: Indices) -> VisibleMesh:
        """The elements of some triangles of the obstacle, ascending."""
        corners = self.obstacle.triangles[near]
        vertices = np.unique(corners)
        places = np.searchsorted(vertices, corners).astype(np.int32)
        first_edge, first_vertex = np.searchsorted(
            near, [self.triangle_count, self.triangle_count + len(self.loose_edges)]
        )
        faces = self._faces_of(near[:first_edge])
        numbers = self.loose_numbers[near[first_edge:first_vertex] - self.triangle_count]
        edges = places[first_edge:first_vertex, :2]
        cropped = CroppedMesh(
            vertices, self.local[vertices], places[:first_edge], faces, edges, numbers, len(self.local)
        )
        return VisibleMesh(
            self.owner, self.source, cropped.local, self.matrix, cropped.triangles, cropped.faces, edges, numbers,
            cropped, shown_in=self.shown_in, static=True,
        )  # fmt: skip

    def _faces_of(self, triangles: Indices) -> Indices:
        """Face of each of some triangles of the mesh. A face with n corners has n - 2 of them."""
        if self.starts is None:
            return triangles
        firsts = self.starts - 2 * np.arange(len(self.starts), dtype=np.int32)
        return np.searchsorted(firsts, triangles, side="right").astype(np.int32) - 1
