# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last drags came to, so that the redo panel gives the state that was seen, to the last bit.

A drag goes its own way to its value: around a corner, for instance, where the straight way of a script would be
blocked. An operator that repeats it names the outcome by its number; where the scene starts from the same state with
the same values, the controls that were accepted then are taken up again, and tested again.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

MOST = 16


@dataclass
class Outcome:
    """The end of one drag.

    Attributes:
        start: digest of the state that it started from.
        controls: (m, 3) that were accepted.
        result: of the solver.
        report: on what was written.
        shown: whether the scene is in this state right now, so that there is nothing to do but to register it.
        values: of the operator's properties, as Blender stored them.

    """

    start: str
    controls: Any
    result: Any
    report: Any
    shown: bool = True
    values: tuple[Any, ...] = ()


_kept: OrderedDict[int, Outcome] = OrderedDict()


def keep(outcome: Outcome) -> int:
    """Keep an outcome; its number, from 1. Old ones are forgotten."""
    number = next(reversed(_kept), 0) + 1
    _kept[number] = outcome
    while len(_kept) > MOST:
        _kept.popitem(last=False)
    return number


def find(number: int) -> Outcome | None:
    """The outcome of a number; None for 0 and for what is forgotten."""
    return _kept.get(number)


def clear() -> None:
    """Forget all."""
    _kept.clear()
