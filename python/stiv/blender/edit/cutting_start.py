# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts an edit of selected objects that cut each other, such as the shaft and the head of an arrow: they move as one.

Alone, each would round its own place, and a rounding that deepens a cut stops them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from stiv.blender.edit.snapshot import EditSnapshot, Names
from stiv.blender.edit.solver import SelectionCutsItselfError
from stiv.blender.edit.touching_start import PartedStart, start_apart_steps
from stiv.task import Steps


def start_as_one_steps(
    read: Callable[[frozenset[Names]], Steps[EditSnapshot]],
) -> Steps[PartedStart]:
    """Steps that read the scene and start a solver, with selected objects that cut each other as one.

    read: makes steps that read the scene, from pairs of names of objects that cut each other. Raise InputError and
    StartIntersectsError, with nothing changed.
    """
    cutting: frozenset[Names] = frozenset()
    while True:  # with more pairs each time, since parting rounds, too
        try:
            return (yield from start_apart_steps(partial(read, cutting)))
        except SelectionCutsItselfError as error:
            cutting = error.pairs
