# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations of a mesh by handles: some vertices are controls, some are fixed, and the others follow."""

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import Deformation
from stiv.arrays import as_floats, as_indices


def laplacian(
    vertices: ArrayLike,
    triangles: ArrayLike,
    handles: ArrayLike,
    *,
    fixed: ArrayLike = (),
    pull: ArrayLike | float | None = 1.0,
    edge_weights: str = "uniform",
) -> Deformation:
    """Return Laplacian editing: handles move a mesh that preserves its differential coordinates.

    The surface q minimizes |L (q - vertices)|^2 + sum pull_k |q[handles[k]] - p_k|^2 for the Laplacian L with rows
    divided by their diagonal. [Sorkine et al. 2004] Controls are the positions of the handles, (m, 3). At
    `vertices[handles]`, the mesh is at rest. The map is linear, and `compose` can apply linear deformations to it, such
    as a subdivision to a cage. This function solves the equations once, which takes seconds for 40,000 vertices and 500
    handles.

    vertices      (n, 3) positions at rest, length
    triangles     (F, 3)
    handles       (m,) vertices, each once
    fixed         vertices that never move; components of the mesh without a handle do not move either
    pull          stiffness of soft handles, > 0, one for all or (m,); None: handles are hard constraints
    edge_weights  "uniform": 1 for all edges; "cotangent": by the opposite angles at rest, which compensates for
                  triangles of different sizes and shapes

    Raises InputError naming the element: an index out of range, a repeated or fixed handle, a number that is not
    finite, a pull that is not positive.
    """
    return _native.laplacian(_handles(vertices, triangles, handles, fixed, pull, edge_weights))


def arap(
    vertices: ArrayLike,
    triangles: ArrayLike,
    handles: ArrayLike,
    *,
    fixed: ArrayLike = (),
    pull: ArrayLike | float | None = 1.0,
    edge_weights: str = "cotangent",
) -> Deformation:
    """Return as-rigid-as-possible editing: neighborhoods of the mesh rotate, and stretch as little as possible.

    The surface q and a rotation R_i for each vertex minimize
    1/4 sum_i sum_j w_ij |(q_i - q_j) - R_i (vertices_i - vertices_j)|^2 + 1/2 sum pull_k |q[handles[k]] - p_k|^2.
    [Sorkine and Alexa 2007] Not linear in the controls: each surface is a minimization from the rest positions, which
    takes 20 to 100 times as long as with `laplacian`. The surface depends on the controls alone. If there are several
    minima, a small change of the controls can lead to another one.

    Arguments and errors are those of `laplacian`.
    """
    return _native.arap(_handles(vertices, triangles, handles, fixed, pull, edge_weights))


def stored_mesh(mesh: Deformation, frame: ArrayLike) -> Deformation:
    """Return a deformation by handles whose surface is stored in single precision.

    A vertex at q is stored as `frame @ float32(inverse(frame) @ q)`. A stored vertex that does not move stays exactly
    the same. `compose` can apply a linear deformation to the stored vertices. Controls are not stored and not
    rounded.

    mesh   of `laplacian` or `arap`
    frame  (4, 4) affine, local to world

    Raises InputError for another deformation, and for a frame that is singular, not affine or not finite.
    """
    return _native.stored_mesh(mesh, as_floats(frame, "frame", (4, 4)))


def _handles(
    vertices: ArrayLike,
    triangles: ArrayLike,
    handles: ArrayLike,
    fixed: ArrayLike,
    pull: ArrayLike | float | None,
    edge_weights: str,
) -> _native.Handles:
    rest = as_floats(vertices, "vertices", (None, 3))
    count = len(rest)
    controls = as_indices(handles, "handles", (None,), count)
    if pull is None:
        pulls = np.empty(0)
    else:
        pulls = as_floats(
            np.broadcast_to(pull, len(controls)) if np.ndim(pull) == 0 else pull, "pull", (len(controls),)
        )
    return _native.Handles(
        rest,
        as_indices(triangles, "triangles", (None, 3), count),
        controls,
        pulls,
        as_indices(fixed, "fixed", (None,), count),
        edge_weights,
    )
