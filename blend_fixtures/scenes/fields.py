# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids as functions of space, negative inside and close to the distance outside, that blend smoothly."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Field = Callable[[Array], Array]  # points (n, 3) -> values (n,)


def _length(vectors: Array) -> Array:
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))


def ellipsoid(centre: ArrayLike, radii: ArrayLike) -> Field:
    """An upright ellipsoid; its values are distances to first order near the surface."""
    middle, axes = np.asarray(centre, float), np.asarray(radii, float)

    def value(points: Array) -> Array:
        scaled = (points - middle) / axes
        size = _length(scaled)
        slope = _length(scaled / axes)
        stretch = np.where(slope > 1e-9, size / np.maximum(slope, 1e-9), axes.min())  # at the centre the slope is 0
        return (size - 1) * stretch

    return value


def limb(first: ArrayLike, last: ArrayLike, radius: float, last_radius: float | None = None) -> Field:
    """A rounded rod from `first` to `last` whose radius changes linearly."""
    start, axis = np.asarray(first, float), np.subtract(last, first)
    end_radius = radius if last_radius is None else last_radius

    def value(points: Array) -> Array:
        along = np.clip((points - start) @ axis / (axis @ axis), 0, 1)
        distance = _length(points - start - along[:, None] * axis)
        return distance - radius - along * (end_radius - radius)

    return value


def path(points: ArrayLike, radii: ArrayLike) -> Field:
    """Rods between consecutive points (k, 3) with a radius (k,) at each."""
    stations, sizes = np.asarray(points, float), np.asarray(radii, float)
    return merged(
        *(limb(stations[i], stations[i + 1], sizes[i], sizes[i + 1]) for i in range(len(stations) - 1)), smooth=0.0
    )


def ring(centre: ArrayLike, normal_axis: int, radius: float, thickness: float) -> Field:
    """A torus about a coordinate axis."""
    middle = np.asarray(centre, float)
    across = [axis for axis in range(3) if axis != normal_axis]

    def value(points: Array) -> Array:
        local = points - middle
        around = _length(local[:, across]) - radius
        return np.hypot(around, local[:, normal_axis]) - thickness

    return value


def half_space(axis: int, bound: float, below: bool = True) -> Field:
    """All points whose coordinate is below (or above) a bound."""
    sign = 1.0 if below else -1.0
    return lambda points: sign * (points[:, axis] - bound)


def merged(*fields: Field, smooth: float = 0.1) -> Field:
    """The union; where two solids meet, a fillet of size `smooth` (polynomial smooth minimum)."""

    def join(one: Field, other: Field) -> Field:
        def value(points: Array) -> Array:
            a, b = one(points), other(points)
            if smooth == 0:
                return np.minimum(a, b)
            share = np.clip(1 - np.abs(a - b) / smooth, 0, 1)
            return np.minimum(a, b) - smooth / 4 * share * share

        return value

    return reduce(join, fields)


def without(solid: Field, *others: Field, smooth: float = 0.0) -> Field:
    """A solid minus other solids."""
    cut = merged(lambda points: -solid(points), *others, smooth=smooth)
    return lambda points: -cut(points)


def grown(solid: Field, distance: float) -> Field:
    """The solid, thickened by `distance`."""
    return lambda points: solid(points) - distance


def mirrored(solid: Field, axis: int = 0) -> Field:
    """The solid and its mirror image, given on the positive side of an axis."""

    def value(points: Array) -> Array:
        folded = points.copy()
        folded[:, axis] = np.abs(folded[:, axis])
        return solid(folded)

    return value
