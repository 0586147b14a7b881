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
class StaticShape:
    """The elements of an evaluated mesh in its own frame. All instances of the mesh share them.

    Attributes:
        local: positions as stored, (n, 3).
        corners: vertex of each corner of all faces.
        starts: first corner of each face, then the number of corners, (F + 1,); None if all faces are triangles.
        loose_edges: (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        loose_vertices: vertices without edges, (k,).
        triangles: of all faces, then one with two corners for each loose edge, then one with one corner for each loose
            vertex.
    """

    local: Singles
    corners: Indices
    starts: Indices | None
    loose_edges: Indices
    loose_numbers: Indices
    loose_vertices: Indices
    triangles: Indices

    @property
    def triangle_count(self) -> int:
        """Number of triangles of all faces."""
        return len(self.triangles) - len(self.loose_edges) - len(self.loose_vertices)

    def faces_of(self, triangles: Indices) -> Indices:
        """Face of each of some triangles. A face with n corners has n - 2 of them."""
        if self.starts is None:
            return triangles
        firsts = self.starts - 2 * np.arange(len(self.starts), dtype=np.int32)
        return np.searchsorted(firsts, triangles, side="right").astype(np.int32) - 1


@dataclass(frozen=True, eq=False)
class StaticMesh:
    """One evaluated mesh, its placement in the world, and the obstacle made from both.

    Attributes:
        owner: the object that shows it.
        source: name of the object whose data is shown.
        number: of the mesh among those that the owner shows, in Blender's order.
        shape: its elements, which are also those of the obstacle.
        matrix: frame to world, (4, 4).
        shown_in: the evaluations that show the mesh.
        obstacle: in the world.
    """

    owner: ObjectReference
    source: str
    number: int
    shape: StaticShape
    matrix: Floats
    shown_in: frozenset[str]
    obstacle: stiv.Obstacle

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
        return len(self.shape.local)

    @property
    def triangle_count(self) -> int:
        """Number of triangles of the mesh."""
        return self.shape.triangle_count

    def element(self, triangle: int) -> Element:
        """The element of a triangle of the obstacle."""
        kinds = self.elements(np.array([triangle], np.int32))
        return next(replace(kind, number=int(numbers[0])) for kind, numbers in kinds if len(numbers))

    def elements(self, triangles: Indices) -> tuple[tuple[Element, Indices], ...]:
        """The faces, edges and vertices of some triangles of the obstacle, ascending; each kind with its numbers."""
        shape, first = self.shape, self.triangle_count + len(self.shape.loose_edges)
        edges, vertices = np.searchsorted(triangles, [self.triangle_count, first])
        numbers = {
            "face": shape.faces_of(triangles[:edges]),
            "edge": shape.loose_numbers[triangles[edges:vertices] - self.triangle_count],
            "vertex": shape.loose_vertices[triangles[vertices:] - first],
        }
        return tuple((Element(self.owner.name, kind, 0), own) for kind, own in numbers.items())

    def cropped(self, near: Indices) -> VisibleMesh:
        """The elements of some triangles of the obstacle, ascending."""
        shape = self.shape
        corners = shape.triangles[near]
        vertices = np.unique(corners)
        places = np.searchsorted(vertices, corners).astype(np.int32)
        first_edge, first_vertex = np.searchsorted(
            near, [shape.triangle_count, shape.triangle_count + len(shape.loose_edges)]
        )
        faces = shape.faces_of(near[:first_edge])
        numbers = shape.loose_numbers[near[first_edge:first_vertex] - shape.triangle_count]
        edges = places[first_edge:first_vertex, :2]
        cropped = CroppedMesh(
            vertices, shape.local[vertices], places[:first_edge], faces, edges, numbers, len(shape.local)
        )
        return VisibleMesh(
            self.owner, self.source, cropped.local, self.matrix, cropped.triangles, cropped.faces, edges, numbers,
            cropped, shown_in=self.shown_in, static=self.number,
        )  # fmt: skip
