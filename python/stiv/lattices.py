# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices: free-form deformation by a grid of points, with the results of Blender's Lattice modifier."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Floats, as_floats
from stiv.weights import Weights


def lattice_rest_points(resolution: Sequence[int]) -> Floats:
    """Return the points of a lattice in its own space, (u v w, 3): 1 apart, centred on the origin, u fastest.

    A lattice in a Blender file can have other rest positions; read them from the file.
    """
    axes = [np.arange(points) - (points - 1) / 2 for points in _resolution(resolution)]
    w, v, u = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return np.stack([u.ravel(), v.ravel(), w.ravel()], axis=1)


def lattice_weights(
    vertices: ArrayLike,
    resolution: Sequence[int],
    *,
    interpolation: str | Sequence[str] = "bspline",
    influence: ArrayLike | float = 1.0,
    rest: ArrayLike | None = None,
    point_weights: ArrayLike | None = None,
) -> Weights:
    """Return the weights W, (n, u v w), of the points of a lattice: vertices move to x + W (p - rest).

    vertices       (n, 3) undeformed positions in lattice space; they may lie outside the lattice
    resolution     number of points along u, v and w, 1 to 64 each
    interpolation  "linear", "cardinal", "catmull_rom" or "bspline"; one for all axes, or three
    influence      the modifier's strength times the weights of its vertex group, a number or (n,)
    rest           (u v w, 3) undeformed points in lattice space, u fastest, equally spaced along each axis; None:
                   `lattice_rest_points`
    point_weights  (u v w,) weights of the lattice's own vertex group, with which the influence applies twice, as in
                   Blender; None: no group

    Raises InputError naming the element: a resolution out of range, sizes that do not match, a number that is not
    finite, points that coincide along an axis.
    """
    places = as_floats(vertices, "vertices", (None, 3))
    definition = _definition(resolution, interpolation, _rest_points(rest, resolution), point_weights)
    return Weights(*_native.lattice_weights(definition, places, _influence(influence, places)))


def lattice(
    vertices: ArrayLike,
    resolution: Sequence[int],
    *,
    frame: ArrayLike | None = None,
    interpolation: str | Sequence[str] = "bspline",
    influence: ArrayLike | float = 1.0,
    rest: ArrayLike | None = None,
    point_weights: ArrayLike | None = None,
) -> Deformation:
    """Return the deformation of a surface by a lattice around it.

    Controls are the world positions of the lattice's points, (u v w, 3), u fastest:
    q = vertices + W (p - rest points in world space). Other arguments are those of `lattice_weights`.

    vertices  (n, 3) world positions of the undeformed surface, length
    frame     (4, 4) affine matrix from lattice space to world space; None: identity

    Raises InputError as `lattice_weights` does, or if `frame` cannot be inverted.
    """
    surface = as_floats(vertices, "vertices", (None, 3))
    to_world = np.eye(4) if frame is None else as_floats(frame, "frame", (4, 4))
    points = _rest_points(rest, resolution)
    definition = _definition(resolution, interpolation, points, point_weights)
    places = _transform(_inverse(to_world), surface)
    return _native.lattice(definition, places, _influence(influence, places), surface, _transform(to_world, points))


def _rest_points(rest: ArrayLike | None, resolution: Sequence[int]) -> Floats:
    return lattice_rest_points(resolution) if rest is None else as_floats(rest, "rest", (None, 3))


def _definition(
    resolution: Sequence[int], interpolation: str | Sequence[str], points: Floats, point_weights: ArrayLike | None
) -> _native.Lattice:
    group = np.empty(0) if point_weights is None else as_floats(point_weights, "point_weights", (None,))
    return _native.Lattice(_resolution(resolution), _interpolations(interpolation), points, group)


def _resolution(resolution: Sequence[int]) -> list[int]:
    values = [int(points) for points in resolution]
    if len(values) != 3 or min(values) < 1 or max(values) > 64:
        raise InputError(
            f"resolution: expected the number of points along three axes, 1 to 64 each, not {tuple(resolution)}"
        )
    return values


def _interpolations(interpolation: str | Sequence[str]) -> list[str]:
    names = [interpolation] * 3 if isinstance(interpolation, str) else list(interpolation)
    if len(names) != 3:
        raise InputError(f"interpolation: expected one name or three, not {len(names)}")
    return names


def _influence(influence: ArrayLike | float, vertices: Floats) -> Floats:
    if np.ndim(influence) == 0:
        influence = np.full(len(vertices), influence)
    return as_floats(influence, "influence", (len(vertices),))


def _inverse(frame: Floats) -> Floats:
    try:
        inverse: Floats = np.linalg.inv(frame).astype(np.float64)
    except np.linalg.LinAlgError as error:
        raise InputError("frame: the matrix is singular; scale the lattice to a size above zero") from error
    return inverse


def _transform(matrix: Floats, points: Floats) -> Floats:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
