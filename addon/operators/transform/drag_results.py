# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the last drags, so that the redo panel restores the state that the user saw, to the last bit.

A drag may take a path around an obstacle where the straight path of a script would be blocked. The operator that
repeats a drag refers to its result by number. If the scene starts from the same state with the same values, the
operator takes the accepted controls of the drag and tests them again.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ... import stiv_blender

CAPACITY = 16


@dataclass
class DragResult:
    """The end of one drag.

    Attributes:
        start: digest of the state at the start.
        controls: (m, 3) accepted controls.
        result: the result of the last solve.
        report: the report on writing it.
        shown: whether the scene is in this state now and only has to be registered.
        values: values of the operator's properties, as Blender stored them.
        outcome: the message on the result.

    """

    start: str
    controls: NDArray[np.float64]
    result: stiv_blender.EditResult
    report: stiv_blender.WriteReport
    shown: bool = True
    values: tuple[object, ...] = ()
    outcome: str = ""


_results: OrderedDict[int, DragResult] = OrderedDict()


def store(result: DragResult) -> int:
    """Store a result; returns its number, from 1. The oldest results are deleted."""
    number = next(reversed(_results), 0) + 1
    _results[number] = result
    while len(_results) > CAPACITY:
        _results.popitem(last=False)
    return number


def find(number: int) -> DragResult | None:
    """The result with a number; None for 0 and for deleted results."""
    return _results.get(number)


def clear() -> None:
    """Delete all results."""
    _results.clear()
