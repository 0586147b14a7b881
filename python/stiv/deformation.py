# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations: maps q = f(p) from controls, (m, 3), to the positions of a surface, (n, 3).

Controls and positions are float64, in world space and in the caller's unit of length. A row of controls is a vertex, a
cage vertex or a lattice point. A rigid body has two rows: its center and its rotation vector.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Floats, as_count, as_floats, as_indices
from stiv.weights import Weights, as_weights

__all__ = [
    "Deformation",
    "compose",
    "concatenate",
    "identity",
    "linear",
    "linear_weights",
    "rigid",
    "rigid_rest_controls",
    "scaling",
    "scaling_rest_controls",
]


def identity(vertex_count: int) -> Deformation:
    """Return q = p, with one control per vertex.

    Raises InputError if `vertex_count` is negative.
    """
    return _identity(as_count(vertex_count, "vertex_count"))


@lru_cache(maxsize=8)
def _identity(count: int) -> Deformation:
    """One object for equal counts: the next edit recognises a session by its deformations."""
    return _native.identity(count)


def linear(matrix: Any, offset: ArrayLike | None = None) -> Deformation:
    """Return q = M p + c, with the same weights for x, y and z.

    matrix  M, (n, m): Weights, a sparse matrix of SciPy, any object with `indptr`, `indices`, `data` and `shape` in
            CSR format, a tuple of these four, or a dense array. Several weights of one control in a row are added.
    offset  c, (n, 3), length; None: zero

    Raises InputError naming the row: inconsistent lists, a control out of range, a number that is not finite.
    """
    weights = as_weights(matrix, "matrix")
    rows = weights.shape[0]
    shift = np.empty((0, 3)) if offset is None else as_floats(offset, "offset", (rows, 3))
    return _native.linear(weights.indptr, weights.indices, weights.data, weights.shape[1], shift)


def linear_weights(deformation: Deformation) -> tuple[Weights, Floats | None]:
    """Return the weights (n, m) and the offset (n, 3), None where there is none, of a linear deformation.

    Raises InputError if the deformation is not one of sparse weights (see `linear`, `lattice`, `catmull_clark`, `loop`,
    `compose`).
    """
    parts = _native.linear_parts(deformation)
    if parts is None:
        raise InputError("deformation: only linear deformations have weights")
    rows, offset = parts
    return Weights(*rows), offset if len(offset) else None


def compose(outer: Deformation | Weights, *inner: Deformation | Weights) -> Deformation:
    """Return the deformation q = outer(inner(...(p))).

    The last one acts first: `compose(subdivision, lattice)` subdivides the mesh that the lattice deforms. Each has as
    many controls as the next one has vertices. Weights are linear deformations without offset. The last one may be a
    deformation by handles (`laplacian`, `arap`) or by `scalars`. All others need sparse weights, or are `observed`.

    Raises InputError if numbers do not match, or for another kind of deformation.
    """
    chain = [linear(part) if isinstance(part, Weights) else part for part in (outer, *inner)]
    result = chain[-1]
    for part in reversed(chain[:-1]):
        result = _native.compose(part, result)
    return result


def rigid(vertices: ArrayLike, pivot: ArrayLike | None = None) -> Deformation:
    """Return the motion of a rigid body: q_i = center + R r_i.

    r_i = vertices_i - mean of the vertices. Controls are (2, 3): the center, and the rotation vector
    of R (axis times angle in radians). At `rigid_rest_controls(vertices)`, all vertices are at rest.

    vertices  (n, 3) world positions at rest, length
    pivot     (3,) fixed point of the rotation; the center then only translates. The response neglects the coupling of
              both rows, so give one of them weight 0. None: the mean of the vertices, and no coupling

    Raises InputError naming a vertex that is not finite.
    """
    about = None if pivot is None else as_floats(pivot, "pivot", (3,))
    return _native.rigid(as_floats(vertices, "vertices", (None, 3)), about)


def rigid_rest_controls(vertices: ArrayLike) -> Floats:
    """Return the controls, (2, 3), of `rigid(vertices)` at rest: the mean of the vertices, and zero."""
    return _native.rigid_rest_controls(as_floats(vertices, "vertices", (None, 3)))


def scaling(vertices: ArrayLike, rotation: ArrayLike) -> Deformation:
    """Return an object's scaling along its own axes: q_i = center + R diag(s) R^T r_i.

    r_i = vertices_i - mean of the vertices. Controls are (2, 3): the center and the scale factors s. At
    `scaling_rest_controls(vertices)`, all vertices are at rest.

    vertices  (n, 3) world positions at rest, length
    rotation  R, (3, 3): its columns are the object's axes in world space, orthonormal

    Raises InputError naming a vertex that is not finite, or if `rotation` is not a rotation.
    """
    axes = as_floats(rotation, "rotation", (3, 3))
    return _native.scaling(as_floats(vertices, "vertices", (None, 3)), axes)


def scaling_rest_controls(vertices: ArrayLike) -> Floats:
    """Return the controls, (2, 3), of `scaling(vertices, ...)` at rest: the mean of the vertices, and 1."""
    return _native.scaling_rest_controls(as_floats(vertices, "vertices", (None, 3)))


def concatenate(parts: Sequence[tuple[Deformation, ArrayLike]], start: ArrayLike) -> Deformation:
    """Return several deformations side by side on one surface.

    Controls are stacked in the order of the components. Each component responds in its own metric.

    parts  pairs of a deformation and the vertices (k,) of the whole surface that it moves, in its own order
    start  (N, 3) positions of the whole surface, length; all other vertices stay there

    Raises InputError naming component and vertex: an index out of range, a vertex in two components, or a number of
    vertices that does not match the deformation.
    """
    whole = as_floats(start, "start", (None, 3))
    native = [
        (deformation, as_indices(vertices, f"parts[{k}], vertices", (None,), len(whole)))
        for k, (deformation, vertices) in enumerate(parts)
    ]
    return _native.concatenate(native, whole)
