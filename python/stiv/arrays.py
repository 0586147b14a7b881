# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of arguments. Their results are safe to pass to the native core."""

from enum import Enum
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv._native import InputError

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
Choice = TypeVar("Choice", bound=Enum)


def _as_array(value: ArrayLike, name: str) -> NDArray[Any]:
    try:
        return np.asarray(value)
    except ValueError as error:
        raise InputError(f"{name}: rows differ in length") from error


def _describe(shape: tuple[int | None, ...]) -> str:
    sizes = ["any" if size is None else str(size) for size in shape]
    return "(" + ", ".join(sizes) + ("," if len(sizes) == 1 else "") + ")"


def _check_shape(array: NDArray[Any], name: str, shape: tuple[int | None, ...]) -> None:
    fits = array.ndim == len(shape) and all(
        want is None or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise InputError(f"{name}: shape is {array.shape}, expected {_describe(shape)}")


def as_reals(value: ArrayLike, name: str, shape: tuple[int | None, ...]) -> Floats:
    """Return `value` as a contiguous float64 array with a shape in which None is any size, without a copy if it is one.

    Numbers that are not finite pass: the core checks them.
    """
    array = _as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise InputError(f"{name}: dtype is {array.dtype}, expected real numbers")
    _check_shape(array, name, shape)
    result: Floats = np.ascontiguousarray(array, np.float64)
    return result if result.flags.aligned else result.copy()  # the core reads it in place


def check_finite(array: Floats, name: str) -> None:
    """Raise InputError naming the first row with a number that is not finite."""
    finite = np.isfinite(array)
    if not finite.all():
        row = int(np.argwhere(~finite)[0][0])
        raise InputError(f"{name}, row {row}: a number is not finite")


def as_floats(value: ArrayLike, name: str, shape: tuple[int | None, ...]) -> Floats:
    """Return `value` as a contiguous float64 array with a shape in which None is any size.

    Raises InputError naming the first row with a number that is not finite.
    """
    result = as_reals(value, name, shape)
    check_finite(result, name)
    return result


def as_indices(value: ArrayLike, name: str, shape: tuple[int | None, ...], count: int | None = None) -> Indices:
    """Return `value` as a contiguous int32 array with a shape in which None is any size.

    Raises InputError naming the first row with an index outside 0..count-1; None: with one that does not fit int32.
    """
    array = _as_array(value, name)
    if array.size == 0 and array.ndim != len(shape):
        array = np.empty([size or 0 for size in shape], np.int32)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise InputError(f"{name}: dtype is {array.dtype}, expected integers")
    _check_shape(array, name, shape)
    limit = np.iinfo(np.int32).max if count is None else count
    if array.size > 0 and (array.min() < 0 or array.max() >= limit):
        where = tuple(np.argwhere((array < 0) | (array >= limit))[0])
        raise InputError(f"{name}, row {where[0]}: index {array[where]} is out of range 0..{limit - 1}")
    return np.ascontiguousarray(array, np.int32)


def as_number(value: float, name: str, low: float = -np.inf) -> float:
    """Return `value` as a finite float of at least `low`."""
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: expected a number, not {value!r}") from error
    if not np.isfinite(number) or number < low:
        bound = "" if low == -np.inf else f" and at least {low:g}"
        raise InputError(f"{name} must be finite{bound}, not {number}")
    return number


def as_count(value: int, name: str) -> int:
    """Return `value` as a non-negative integer of int32."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not 0 <= value < 2**31:
        raise InputError(f"{name}: expected a non-negative integer, not {value!r}")
    return int(value)


def as_choice(value: str, name: str, choices: type[Choice]) -> Choice:
    """Return the member of an enum of the core with the name `value`."""
    if value not in choices.__members__:
        raise InputError(f"{name}: {value!r} is none of {', '.join(map(repr, choices.__members__))}")
    return choices[value]
