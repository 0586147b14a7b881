# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces: the triangles of all objects as one mesh."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Indices, as_count, as_indices


@dataclass(frozen=True)
class Body:
    """A named part of a surface: an object.

    `mobility` determines the tested pairs: "fixed" bodies are not tested against each other or themselves, "rigid"
    bodies not against themselves, "deformable" bodies against everything.
    """

    name: str
    mobility: str = "deformable"


class Surface:
    """Connectivity of a surface, immutable. Positions are separate (N, 3) float64 arrays.

    triangles     (F, 3) vertex indices; degenerate triangles with repeated corners are allowed
    vertex_count  N; None: one more than the largest index
    loose_edges   (L, 2) edges without a triangle
    vertex_body   (N,) body of each vertex; None: all of body 0
    bodies        sequence of Body; None: one deformable body named "surface"
    ignored       pairs of bodies that are never tested; a body may be paired with itself
    flip_faces    vertices of each polygon with several triangulations, which intersect each other: primitives with all
                  vertices in one such polygon are never tested

    Raises InputError naming the element: an index out of range, a face or edge with two bodies.
    """

    def __init__(
        self,
        triangles: ArrayLike,
        vertex_count: int | None = None,
        loose_edges: ArrayLike | None = None,
        vertex_body: ArrayLike | None = None,
        bodies: Sequence[Body] | None = None,
        ignored: Sequence[tuple[int, int]] = (),
        flip_faces: Sequence[Sequence[int]] = (),
    ) -> None:
        """Check and store the description."""
        self.triangles: Indices = as_indices(triangles, "triangles", (None, 3))
        self.loose_edges: Indices = as_indices([] if loose_edges is None else loose_edges, "loose_edges", (None, 2))
        if vertex_count is None:
            corners = np.concatenate([self.triangles.ravel(), self.loose_edges.ravel()])
            vertex_count = int(corners.max(initial=-1)) + 1
        self.vertex_count: int = as_count(vertex_count, "vertex_count")
        self.bodies: tuple[Body, ...] = (Body("surface"),) if bodies is None else tuple(bodies)
        self.vertex_body: Indices = (
            np.zeros(self.vertex_count, np.int32)
            if vertex_body is None
            else as_indices(vertex_body, "vertex_body", (self.vertex_count,), len(self.bodies))
        )
        self.ignored: Indices = as_indices(list(ignored), "ignored", (None, 2), len(self.bodies))
        self.flip_faces: tuple[tuple[int, ...], ...] = tuple(tuple(map(int, face)) for face in flip_faces)
        self.native = _native.Surface(
            self.vertex_count,
            self.triangles,
            self.loose_edges,
            self.vertex_body,
            [(body.name, body.mobility) for body in self.bodies],
            [(int(a), int(b)) for a, b in self.ignored],
            [list(face) for face in self.flip_faces],
        )
        for array in (self.triangles, self.loose_edges, self.vertex_body, self.ignored):
            array.setflags(write=False)

    @property
    def edges(self) -> Indices:
        """Every edge once, (E, 2), smaller index first, in lexicographic order, including loose edges."""
        return self.native.edges


def as_surface(surface: Surface | ArrayLike, vertex_count: int) -> Surface:
    """Return a surface unchanged, and triangles (F, 3) as a surface of `vertex_count` vertices."""
    if not isinstance(surface, Surface):
        return Surface(surface, vertex_count)
    if surface.vertex_count != vertex_count:
        raise InputError(f"positions have {vertex_count} rows, the surface has {surface.vertex_count} vertices")
    return surface
