# SPDX-License-Identifier: GPL-3.0-or-later
"""Sparse weights of controls for vertices, in SciPy's CSR format without SciPy."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stiv._native import InputError
from stiv.arrays import Floats, Indices, as_floats, as_indices


@dataclass(frozen=True, eq=False)
class Weights:
    """A sparse matrix M, (n, m): the weights of m controls for n vertices, the same for x, y and z.

    Vertex i has the weights data[indptr[i]:indptr[i + 1]] of the controls indices[indptr[i]:indptr[i + 1]]. In SciPy,
    the same matrix is scipy.sparse.csr_array((data, indices, indptr), shape).
    """

    indptr: Indices  #: (n + 1,) int32
    indices: Indices  #: (nnz,) int32
    data: Floats  #: (nnz,) float64
    shape: tuple[int, int]  #: (n, m)

    def dense(self) -> Floats:
        """Return M as an (n, m) array."""
        matrix = np.zeros(self.shape)
        rows = np.repeat(np.arange(self.shape[0]), np.diff(self.indptr))
        np.add.at(matrix, (rows, self.indices), self.data)
        return matrix


def as_weights(value: Any, name: str) -> Weights:
    """Return `value` as Weights: a CSR matrix of any library, a tuple of its four fields, or a dense array (n, m)."""
    if isinstance(value, Weights):
        return value
    if hasattr(value, "tocsr"):
        value = value.tocsr()
    if all(hasattr(value, field) for field in ("indptr", "indices", "data", "shape")):
        value = (value.indptr, value.indices, value.data, value.shape)
    if isinstance(value, tuple) and len(value) == 4:
        return _from_rows(*value, name)
    return _from_dense(as_floats(value, name, (None, None)))


def _from_rows(indptr: ArrayLike, indices: ArrayLike, data: ArrayLike, shape: Any, name: str) -> Weights:
    try:
        rows, columns = (int(size) for size in shape)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: shape must be (vertices, controls), not {shape!r}") from error
    return Weights(
        as_indices(indptr, f"{name}.indptr", (rows + 1,)),
        as_indices(indices, f"{name}.indices", (None,), columns),
        _values(data, f"{name}.data"),
        (rows, columns),
    )


def _values(data: ArrayLike, name: str) -> Floats:
    """Values without a check for finite numbers, because the core names the row in its error."""
    values = np.asarray(data)
    if values.dtype.kind not in "fiu" or values.ndim != 1:
        raise InputError(f"{name}: expected real numbers of shape (any,), not {values.dtype} of shape {values.shape}")
    return np.ascontiguousarray(values, np.float64)


def _from_dense(matrix: Floats) -> Weights:
    rows, columns = np.nonzero(matrix)
    counts = np.bincount(rows, minlength=len(matrix))
    indptr = np.concatenate([[0], np.cumsum(counts)])
    return Weights(
        indptr.astype(np.int32), columns.astype(np.int32), matrix[rows, columns], (matrix.shape[0], matrix.shape[1])
    )
