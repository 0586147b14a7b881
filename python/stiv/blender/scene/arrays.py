# SPDX-License-Identifier: GPL-3.0-or-later
"""Array types, and affine maps of points."""

import hashlib
from collections.abc import Iterable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiv.points import apply_linear, transform_points

__all__ = [
    "Flags", "Floats", "Indices", "Singles", "apply_linear", "as_matrix", "diagonal_of", "digest", "extents", "invert",
    "islands", "pair_codes", "read_collection", "split_by_number", "to_local", "transform_points", "translation_matrix",
]  # fmt: skip

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.int32]
Flags = NDArray[np.bool_]


def split_by_number(numbers: NDArray[Any]) -> list[NDArray[np.int64]]:
    """For each number from 0 to the largest, the rows, ascending, of the numbers, (k,), that are equal to it."""
    return np.split(np.argsort(numbers, kind="stable"), np.cumsum(np.bincount(numbers))[:-1])


def pair_codes(pairs: NDArray[Any]) -> NDArray[np.int64]:
    """A number for each pair of numbers below 2^32, (k, 2), in either order."""
    codes: NDArray[np.int64] = (pairs.min(axis=1).astype(np.int64) << 32) + pairs.max(axis=1)
    return codes


def as_matrix(matrix: Iterable[Iterable[float]]) -> Floats:
    """Blender's 4x4 matrix, or any nested sequence, in double precision."""
    return np.array([list(row) for row in matrix], dtype=np.float64)


def translation_matrix(translation: Floats) -> Floats:
    """The matrix, (4, 4), of a translation, (3,)."""
    matrix = np.eye(4)
    matrix[:3, 3] = translation
    return matrix


def invert(matrix: Floats) -> Floats:
    """Inverse of a matrix, (n, n), read-only. The last ones are cached: most are frames that stay during an edit.

    LAPACK would wake the threads of NumPy's BLAS, whatever the size, which then spin beside the solver's.
    """
    return _inverse(len(matrix), np.asarray(matrix, np.float64).tobytes())


@lru_cache(maxsize=256)
def _inverse(size: int, values: bytes) -> Floats:
    inverse = np.linalg.inv(np.frombuffer(values).reshape(size, size)).astype(np.float64)
    inverse.setflags(write=False)
    return inverse


def to_local(matrix: Floats, points: NDArray[Any]) -> Floats:
    """Local coordinates of world positions, (n, 3), in a frame, (4, 4)."""
    return transform_points(invert(matrix), points)


def extents(points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """The least and the greatest coordinates, (3,) each, of points, (n, 3); n > 0. Reductions of rows are slow."""
    columns = np.ascontiguousarray(points.T)
    return columns.min(axis=1), columns.max(axis=1)


def diagonal_of(points: Floats) -> float:
    """Length of the diagonal of the box around points, (n, 3); 0 without points."""
    if len(points) == 0:
        return 0.0
    low, high = extents(points)
    return float(np.linalg.norm(high - low))


def read_collection(collection: Any, attribute: str, width: int, dtype: type) -> NDArray[Any]:
    """Read an attribute of every item of a Blender collection, (n, width), or (n,) for width 1."""
    values: NDArray[Any] = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values if width == 1 else values.reshape(-1, width)


def digest(*values: Any) -> bytes:
    """Digest of arrays and plain values."""
    hasher = hashlib.blake2b(digest_size=20)
    for value in values:
        array = isinstance(value, np.ndarray)
        hasher.update(repr((value.dtype.str, value.shape) if array else value).encode() + b"\0")
        if array:
            hasher.update(np.ascontiguousarray(value).tobytes())
    return hasher.digest()


def islands(count: int, edges: Indices) -> NDArray[np.int64]:
    """Number of each point's island, (count,): the smallest number spreads along edges, (e, 2)."""
    labels = np.arange(count)
    while True:
        before = labels.copy()
        np.minimum.at(labels, edges[:, 0], before[edges[:, 1]])
        np.minimum.at(labels, edges[:, 1], before[edges[:, 0]])
        labels = labels[labels]  # pointer jumping
        if np.array_equal(labels, before):
            return labels
