# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations by scalars, such as angles, lengths and slider values, with limits and longest steps."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Floats, as_reals
from stiv.task import Steps, run

__all__ = ["ScalarDeformation", "difference_jacobian", "scalars"]

Evaluate = Callable[[Floats], ArrayLike | None]


class ScalarDeformation(_native.ScalarDeformation):
    """A deformation q = f(s) by scalars; see :func:`stiv.scalars`."""

    def __init__(
        self,
        evaluate: Evaluate,
        jacobian: ArrayLike,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        longest_step: ArrayLike | None = None,
    ) -> None:
        derivative = as_reals(jacobian, "jacobian", (None, 3, None))
        vertices, _, count = derivative.shape

        def checked(values: Floats) -> Floats | None:
            surface = evaluate(values)
            return None if surface is None else as_reals(surface, "result of evaluate", (vertices, 3))

        super().__init__(
            checked,
            derivative.reshape(3 * vertices, count),
            _of_each(lower, "lower", -np.inf, count),
            _of_each(upper, "upper", np.inf, count),
            _of_each(longest_step, "longest_step", np.inf, count),
        )

    def controls(self, values: ArrayLike) -> Floats:
        """Return the controls, (k, 3), for the values of the scalars, (k,)."""
        controls = np.zeros((self.control_count, 3))
        controls[:, 0] = as_reals(values, "values", (self.control_count,))
        return controls

    def values(self, controls: ArrayLike) -> Floats:
        """Return the values of the scalars, (k,), from controls, (k, 3)."""
        return as_reals(controls, "controls", (self.control_count, 3))[:, 0].copy()

    def set_jacobian(self, jacobian: ArrayLike) -> None:
        """Replace the Jacobian, (n, 3, k), between calls of sessions.

        Every session of a deformation that contains this one uses it from its next call on. It keeps the accepted
        state.

        Raises InputError for another number of vertices or scalars, with nothing changed.
        """
        derivative = as_reals(jacobian, "jacobian", (self.vertex_count, 3, self.control_count))
        self.replace_jacobian(derivative.reshape(-1, self.control_count))


def scalars(
    evaluate: Evaluate,
    jacobian: ArrayLike,
    *,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    longest_step: ArrayLike | None = None,
) -> ScalarDeformation:
    """Return q = f(s) for k scalars s: angles, lengths, slider values.

    Row k of the controls is (s_k, 0, 0); `ScalarDeformation.controls` and `values` convert. The surface comes from
    `evaluate` alone, and the Jacobian only directs the response, as in :func:`stiv.observed`. The response does not
    depend on the units of the scalars. A scalar with weight 0 (`EditOptions.weights`) does not respond.

    evaluate      called with values, (k,); returns positions, (n, 3), length, or None if there is no surface with this
                  topology. Threads and exceptions are as in `observed`
    jacobian      dq/ds, (n, 3, k); see `difference_jacobian`
    lower, upper  limits of each scalar, (k,), or one for all; None: none. No edit leaves them. A goal beyond them is
                  replaced by the nearest values. With `EditOptions.single_precision`, they are rounded inward
    longest_step  the largest change of each scalar in an accepted step, (k,), or one for all; None: any. The surface
                  moves on straight lines within a step: for angles, 0.3 keeps them within 1.1 % of the radius

    Raises InputError naming the scalar: limits in the wrong order, a step that is not positive; naming the element: a
    wrong shape, a number that is not finite.
    """
    return ScalarDeformation(evaluate, jacobian, lower, upper, longest_step)


def difference_jacobian(
    evaluate: Evaluate,
    values: ArrayLike,
    step: ArrayLike = 1e-3,
    *,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
) -> Floats:
    """Return dq/ds at `values`, (n, 3, k), from differences of `evaluate`: two calls for each scalar.

    At a limit, or where `evaluate` returns None on one side, the difference is one-sided. The derivative is 0 where
    there is no surface on either side.

    evaluate      as in `scalars`
    values        (k,)
    step          of each scalar to both sides, (k,), or one for all, > 0
    lower, upper  as in `scalars`

    Raises InputError if there is no surface at `values`, or for shapes that do not match.
    """
    return run(difference_jacobian_steps(evaluate, values, step, lower=lower, upper=upper))


def difference_jacobian_steps(
    evaluate: Evaluate,
    values: ArrayLike,
    step: ArrayLike = 1e-3,
    *,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
) -> Steps[Floats]:
    """Return the steps of :func:`difference_jacobian`, which give a turn after each call of `evaluate`."""
    at = as_reals(values, "values", (None,))
    count = len(at)
    here = evaluate(at.copy())
    if here is None:
        raise InputError("values: evaluate has no surface there; give the Jacobian at others")
    here = as_reals(here, "result of evaluate", (None, 3))
    yield None
    steps = _of_each(step, "step", 0, count)
    least = np.maximum(at - steps, _of_each(lower, "lower", -np.inf, count))
    most = np.minimum(at + steps, _of_each(upper, "upper", np.inf, count))
    jacobian = np.zeros((*here.shape, count))
    for k in range(count):
        ends = [(at[k], here)]
        for value in {float(least[k]), float(most[k])} - {float(at[k])}:
            moved = at.copy()
            moved[k] = value
            surface = evaluate(moved)
            yield None
            if surface is not None:
                ends.append((value, as_reals(surface, "result of evaluate", here.shape)))
        (first, before), (last, after) = min(ends, key=lambda end: end[0]), max(ends, key=lambda end: end[0])
        if last > first:
            jacobian[:, :, k] = (after - before) / (last - first)
    return jacobian


def _of_each(values: ArrayLike | None, name: str, none: float, count: int) -> Floats:
    """Return a value for each scalar, from values, from one for all, or from None."""
    given = np.asarray(none if values is None else values)
    return as_reals(np.full(count, given) if given.ndim == 0 else given, name, (count,))
