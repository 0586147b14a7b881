# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations by a function of the caller, with a Jacobian that directs the response."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import InfeasibleError, InputError
from stiv.arrays import Floats, Indices, as_indices, as_reals
from stiv.weights import as_weights

__all__ = ["InfeasibleError", "ObservedDeformation", "observed"]

Evaluate = Callable[[Floats], ArrayLike | None]
Rows = tuple[Indices, Indices, Floats, tuple[int, int]]  # indptr, indices, data, (n, m)


class ObservedDeformation(_native.ObservedDeformation):
    """A deformation q = f(p) by a function of the caller; see :func:`stiv.observed`."""

    def __init__(self, evaluate: Evaluate, jacobian: Any, rotation_rows: Sequence[int] = ()) -> None:
        indptr, indices, data, (rows, columns) = _as_rows(jacobian)

        def checked(controls: Floats) -> Floats | None:
            surface = evaluate(controls)
            return None if surface is None else as_reals(surface, "result of evaluate", (rows, 3))

        super().__init__(checked, indptr, indices, data, columns, list(rotation_rows))

    def set_jacobian(self, jacobian: Any) -> None:
        """Replace the Jacobian, given as in :func:`stiv.observed`, between calls of sessions.

        Every session of a deformation that contains this one uses it from its next call on. It keeps the accepted
        state.

        Raises InputError for another number of vertices or controls, with nothing changed.
        """
        indptr, indices, data, shape = _as_rows(jacobian)
        if shape != (self.vertex_count, self.control_count):
            raise InputError(f"jacobian: shape is {shape}, expected {(self.vertex_count, self.control_count)}")
        self.replace_jacobian(indptr, indices, data, shape[1])


def observed(evaluate: Evaluate, jacobian: Any, rotation_rows: Sequence[int] = ()) -> ObservedDeformation:
    """Return q = f(p) for a function of yours.

    The surface comes from `evaluate` alone, so the guarantee is that of other deformations: every accepted state is a
    surface that `evaluate` returned. The Jacobian J = df/dp only directs the response. A less accurate one keeps less
    of a motion. Where f is not linear, renew it every few edits with :meth:`ObservedDeformation.set_jacobian`.

    evaluate  called with controls, (m, 3); returns positions, (n, 3), length. They depend on the controls alone.
              None: there is no surface with this topology here. Edits then stop before these controls.
              It runs in the thread that calls the session. For a job, it runs in the thread that calls the job's
              `poll`, `wait` or `result`; until then the job waits. The last result is stored. An exception ends the
              edit, with nothing changed.
    jacobian  J as weights (n, m) as in `linear`, if x, y and z of a control act alike, or as blocks of 3 x 3:
              block[a, b] is the derivative of a vertex's coordinate a by a control's coordinate b. Blocks are a
              bsr_array of SciPy with blocks of (3, 3), a tuple (indptr, indices, data, (n, m)) in CSR format with data
              of shape (k, 3, 3), or a dense array (n, 3, m, 3)
    rotation_rows  controls that are rotation vectors (radians) instead of points, ascending. Their increments are
              composed as rotations, and large ones are split into steps

    Raises InputError naming the row: inconsistent lists, a control out of range, a number that is not finite.
    """
    return ObservedDeformation(evaluate, jacobian, rotation_rows)


def _as_rows(jacobian: Any) -> Rows:
    if all(hasattr(jacobian, field) for field in ("indptr", "indices", "data", "shape")):
        data = np.asarray(jacobian.data)
        if data.ndim == 3:  # the shape of a bsr_array counts coordinates
            rows, columns = (size // 3 for size in jacobian.shape)
            return _block_rows(jacobian.indptr, jacobian.indices, data, (rows, columns))
    if isinstance(jacobian, tuple) and len(jacobian) == 4 and np.ndim(jacobian[2]) == 3:
        return _block_rows(*jacobian)
    if isinstance(jacobian, np.ndarray) and jacobian.ndim == 4:
        return _dense_rows(jacobian)
    weights = as_weights(jacobian, "jacobian")
    return weights.indptr, weights.indices, weights.data, weights.shape


def _block_rows(indptr: ArrayLike, indices: ArrayLike, data: ArrayLike, shape: tuple[int, int]) -> Rows:
    rows, columns = (int(size) for size in shape)
    return (
        as_indices(indptr, "jacobian.indptr", (rows + 1,)),
        as_indices(indices, "jacobian.indices", (None,), columns),
        as_reals(data, "jacobian.data", (None, 3, 3)),
        (rows, columns),
    )


def _dense_rows(jacobian: np.ndarray[Any, Any]) -> Rows:
    blocks = as_reals(jacobian, "jacobian", (None, 3, None, 3)).transpose(0, 2, 1, 3)
    rows, columns = np.nonzero((blocks != 0).any(axis=(2, 3)))
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=len(blocks)))])
    return _block_rows(indptr, columns, blocks[rows, columns], blocks.shape[:2])
