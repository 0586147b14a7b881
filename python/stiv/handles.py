# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations of a mesh by handles: some of its vertices are controls, some are fixed, and the others follow."""

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
    """Return Laplacian editing: a mesh that keeps its differential coordinates while handles pull at it.

    The surface q minimises |L (q - vertices)|^2 + sum pull_k |q[handles[k]] - p_k|^2, L being the Laplacian whose rows
    are divided by their diagonal. [Sorkine et al. 2004] Controls are the handles' positions, (m, 3); at
    `vertices[handles]` nothing is moved. Linear in the controls; may be followed by linear deformations (`compose`),
    for instance as a cage by its subdivision. Its equations are solved here, once: this takes seconds for 40,000
    vertices and 500 handles.

    vertices      (n, 3) positions at rest, length
    triangles     (F, 3)
    handles       (m,) vertices, each once
    fixed         vertices that never move; connected parts of the mesh without a handle do not move either
    pull          how hard a soft handle pulls, > 0, one for all or (m,); None: handles are hard, the surface goes
                  through them
    edge_weights  "uniform": all edges alike; "cotangent": by the angles opposite to them at rest, which makes up for
                  triangles of different sizes and shapes

    Raises InputError naming the element: an index out of range, a handle given twice or fixed too, a number not finite,
    a pull that is not positive.
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
    """Return as-rigid-as-possible editing: a mesh whose neighbourhoods turn, but stretch as little as they can.

    The surface q and a rotation R_i for each vertex minimise
    1/4 sum_i sum_j w_ij |(q_i - q_j) - R_i (vertices_i - vertices_j)|^2 + 1/2 sum pull_k |q[handles[k]] - p_k|^2.
    [Sorkine and Alexa 2007] Not linear in the controls: each surface is a search from the rest positions, some 20 to
    100 times as long as a surface of `laplacian`. The same controls give the same surface, whatever came before; where
    several surfaces are as good, a small change of the controls can lead to another one.

    Arguments and errors are those of `laplacian`.
    """
    return _native.arap(_handles(vertices, triangles, handles, fixed, pull, edge_weights))


def stored_mesh(mesh: Deformation, frame: ArrayLike) -> Deformation:
    """Return the deformation of a mesh by handles whose vertices are stored in single precision.

    Its surface is what is read back: `frame @ float32(inverse(frame) @ q)` for every vertex at q; one that was read
    from storage and is not moved stays as it is, bit by bit. A linear deformation may follow (`compose`), which then
    acts on the stored vertices. The controls, which nothing stores, are taken as they are.

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
