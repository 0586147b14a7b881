# SPDX-License-Identifier: GPL-3.0-or-later
"""Subdivision of cages: Catmull-Clark, with the results of Blender's Subdivision Surface modifier, and Loop."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Indices, as_count, as_floats, as_indices
from stiv.deformation import linear
from stiv.weights import Weights


@dataclass(frozen=True, eq=False)
class Cage:
    """Connectivity of a polygon cage. The order of its elements determines that of the subdivided vertices.

    vertex_count   V
    corners        (C,) vertices of the corners of all faces, face by face
    face_starts    (F + 1,) first corner of each face, and C
    edges          (E, 2) all edges, including loose ones; None: the edges of the faces, smaller vertex first, in
                   lexicographic order
    edge_crease    (E,) in [0, 1]; None: no creases. Requires `edges`
    vertex_crease  (V,) in [0, 1]; None: no creases

    Functions that take a cage raise InputError naming face or edge: fewer than 3 corners, a repeated corner, a vertex
    out of range, an edge missing from `edges`, a crease out of [0, 1].
    """

    vertex_count: int
    corners: ArrayLike
    face_starts: ArrayLike
    edges: ArrayLike | None = None
    edge_crease: ArrayLike | None = None
    vertex_crease: ArrayLike | None = None

    @classmethod
    def of_faces(
        cls,
        faces: Sequence[Sequence[int]] | ArrayLike,
        vertex_count: int | None = None,
        edges: ArrayLike | None = None,
        edge_crease: ArrayLike | None = None,
        vertex_crease: ArrayLike | None = None,
    ) -> "Cage":
        """Return the cage of a list of faces. `vertex_count` None: one more than the largest index."""
        rows = [np.asarray(face).ravel() for face in faces]  # type: ignore[union-attr]
        corners = as_indices(np.concatenate(rows) if rows else [], "faces", (None,))
        starts = np.cumsum([0, *map(len, rows)])
        if vertex_count is None:
            used = [corners, np.zeros(0, np.int32) if edges is None else np.ravel(edges)]
            vertex_count = int(np.concatenate(used).max(initial=-1)) + 1
        return cls(vertex_count, corners, starts, edges, edge_crease, vertex_crease)


def subdivision_weights(
    cage: Cage,
    levels: int = 1,
    *,
    limit_surface: bool = True,
    quality: int = 3,
    simple: bool = False,
    boundary: str = "all",
    scheme: str = "catmull_clark",
) -> Weights:
    """Return the weights of the cage's vertices for the vertices of the subdivided mesh, (n, V).

    Vertices are in Blender's order: those of the cage, then those inside edges (edge by edge), then those inside faces.

    levels         0 to 11: an edge is divided into 2^levels; 0 returns the cage
    limit_surface  whether vertices are on the limit surface instead of on the refined mesh
    quality        1 to 10: levels of refinement around irregular vertices and creases for the limit surface
    simple         whether to divide without smoothing
    boundary       "all": corners of the boundary are rounded; "preserve_corners": they are fixed
    scheme         "catmull_clark"; or "loop" for cages of triangles

    Raises InputError for an invalid cage (see `Cage`) or an option out of range.
    """
    rows = _native.subdivision_weights(_native_cage(cage), levels, limit_surface, quality, simple, boundary, scheme)
    return Weights(*rows)


def subdivided_faces(cage: Cage, levels: int = 1) -> Indices:
    """Return the faces of the subdivided mesh, all quads, (Q, 4), in the vertex order of `subdivision_weights`.

    The faces of one cage face are consecutive and have its orientation.

    levels  1 to 11

    Raises InputError as `subdivision_weights` does.
    """
    return _native.subdivided_faces(_native_cage(cage), levels)


def catmull_clark(
    cage: Cage,
    levels: int = 1,
    *,
    limit_surface: bool = True,
    quality: int = 3,
    simple: bool = False,
    boundary: str = "all",
) -> tuple[Deformation, Indices]:
    """Return the deformation of a subdivision surface by its cage, and the surface's triangles, (T, 3).

    Controls are the world positions of the cage's vertices, (V, 3). A diagonal from the first corner divides each quad
    of `subdivided_faces` into two triangles. Arguments and errors are those of `subdivision_weights`, with levels 1 to
    11.
    """
    quads = subdivided_faces(cage, levels)
    weights = subdivision_weights(
        cage, levels, limit_surface=limit_surface, quality=quality, simple=simple, boundary=boundary
    )
    return linear(weights), quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def loop(
    cage: Cage, levels: int = 1, *, limit_surface: bool = True, quality: int = 3, boundary: str = "all"
) -> tuple[Deformation, Indices]:
    """Return the deformation of a Loop subdivision surface by its cage of triangles, and its triangles, (T, 3).

    Controls are the world positions of the cage's vertices, (V, 3). An edge is divided into 2^levels, a triangle
    into 4^levels, which are consecutive and have its orientation. Creases and boundaries follow the rules of
    `catmull_clark` (a crease of 1 is infinitely sharp) with the masks of Loop's scheme. [Loop 1987; Hoppe et al. 1994]

    Arguments are those of `subdivision_weights`, with levels 1 to 11.

    Raises InputError as `subdivision_weights` does, and for a face that is not a triangle.
    """
    triangles = _native.subdivided_triangles(_native_cage(cage), levels)
    weights = subdivision_weights(
        cage, levels, limit_surface=limit_surface, quality=quality, boundary=boundary, scheme="loop"
    )
    return linear(weights), triangles


def _native_cage(cage: Cage) -> _native.Cage:
    count = as_count(cage.vertex_count, "vertex_count")
    corners = as_indices(cage.corners, "corners", (None,), count)
    starts = as_indices(cage.face_starts, "face_starts", (None,), len(corners) + 1)
    if cage.edges is not None:
        edges = as_indices(cage.edges, "edges", (None, 2), count)
    elif cage.edge_crease is not None:
        raise InputError("edge_crease: `edges` is required, because creases follow its order")
    else:
        edges = _edges_of_faces(corners, starts)
    return _native.Cage(count, edges, corners, starts, _crease(cage.edge_crease), _crease(cage.vertex_crease))


def _edges_of_faces(corners: Indices, starts: Indices) -> Indices:
    following = np.arange(1, len(corners) + 1)
    ends = starts[1:][np.diff(starts) > 0]
    following[ends - 1] = starts[:-1][np.diff(starts) > 0]
    pairs = np.sort(np.stack([corners, corners[following % max(len(corners), 1)]], axis=1), axis=1)
    edges: Indices = np.unique(pairs, axis=0).astype(np.int32)
    return edges


def _crease(crease: ArrayLike | None) -> NDArray[np.float32]:
    values = np.empty(0) if crease is None else as_floats(crease, "crease", (None,))
    return values.astype(np.float32)
