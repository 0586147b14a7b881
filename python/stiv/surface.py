# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces: all triangles of all objects that take part, as one concatenated mesh."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Indices, as_count, as_indices


@dataclass(frozen=True)
class Body:
    """A part of a surface that the user knows by name: an object.

    `mobility` decides which pairs can interfere at all: "fixed" bodies are not tested against each other or themselves,
    "rigid" ones not against themselves, "deformable" ones against everything.
    """

    name: str
    mobility: str = "deformable"


class Surface:
    """Connectivity of a surface; immutable. Positions travel apart, as (N, 3) float64 arrays.

    triangles     (F, 3) vertex indices; repeated corners are allowed (a degenerate face)
    vertex_count  N; None: one more than the largest index
    loose_edges   (L, 2) edges of no triangle; they meet edges, their ends meet faces
    vertex_body   (N,) body of each vertex; None: all of body 0
    bodies        sequence of Body; None: one deformable body named "surface"
    ignored       pairs of bodies that are never tested (a body with itself allowed)
    recut_faces   vertices of each polygon whose triangles come in more than one cut: those cuts cross each other by
                  nature, so primitives of which all vertices belong to one such polygon are never tested

    Raises InputError naming the element: an index out of range, a face or edge across two bodies.
    """

    def __init__(
        self,
        triangles: ArrayLike,
        vertex_count: int | None = None,
        loose_edges: ArrayLike | None = None,
        vertex_body: ArrayLike | None = None,
        bodies: Sequence[Body] | None = None,
        ignored: Sequence[tuple[int, int]] = (),
        recut_faces: Sequence[Sequence[int]] = (),
    ) -> None:
        """Check and take over the description."""
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
        self.recut_faces: tuple[tuple[int, ...], ...] = tuple(tuple(map(int, face)) for face in recut_faces)
        self.native = _native.Surface(
            self.vertex_count,
            self.triangles,
            self.loose_edges,
            self.vertex_body.tolist(),
            [(body.name, body.mobility) for body in self.bodies],
            [(int(a), int(b)) for a, b in self.ignored],
            [list(face) for face in self.recut_faces],
        )
        for array in (self.triangles, self.loose_edges, self.vertex_body, self.ignored):
            array.setflags(write=False)

    @property
    def edges(self) -> Indices:
        """Every edge once, (E, 2), smaller index first, in lexicographic order; loose edges included."""
        return self.native.edges


def as_surface(surface: Surface | ArrayLike, vertex_count: int) -> Surface:
    """Return `surface` itself, or one made of bare triangles (F, 3) over `vertex_count` vertices."""
    if not isinstance(surface, Surface):
        return Surface(surface, vertex_count)
    if surface.vertex_count != vertex_count:
        raise InputError(f"positions have {vertex_count} rows, the surface has {surface.vertex_count} vertices")
    return surface
