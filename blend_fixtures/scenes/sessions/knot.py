# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 11: a knotted tube under Laplacian editing with a fixed bottom, dragged at its top arch."""

from __future__ import annotations

import numpy as np

import stiv

from ..primitives import triangulated
from ..shape import Shape
from ..sweeps import trefoil
from .session import Session, Stage, moved, repeated, single, surface_of

RINGS, SIDES = 264, 22
LIFT, ASIDE, MOVES = 1.6, 0.5, 80
LARGE_MOVES = 20


def shape() -> Shape:
    """5,808 vertices and 11,616 triangles, as in the paper."""
    return triangulated(trefoil(RINGS, SIDES))


def stage(lift: float = LIFT, aside: float = ASIDE, moves: int = MOVES) -> Stage:
    """The top arch lifted in half of the moves, then dragged sideways in the other half."""
    tube = shape()
    height = tube.vertices[:, 1]
    bottom, arch = np.flatnonzero(height < np.quantile(height, 0.12)), np.flatnonzero(height > np.quantile(height, 0.9))
    surface, start = surface_of({"Knot": tube})
    deformation = stiv.laplacian(start, tube.triangles(), arch, fixed=bottom)
    half = moves // 2
    edits = repeated(moved((0, lift / half, 0)), half) + repeated(moved((aside / half, 0, aside / half)), half)
    return Stage("knot", surface, deformation, start[arch], edits)


def session() -> Session:
    """The arch dragged away from the bottom and sideways, in small moves."""
    return Session("knot", 11, "A knot under Laplacian editing, its top arch dragged", single(stage))


def large_moves() -> Session:
    """The arch dragged twice as far in moves eight times as large, for more contacts per round than in the paper."""
    return Session(
        "knot",
        11,
        "A knot under Laplacian editing, its top arch dragged in large moves",
        single(lambda: stage(2 * LIFT, 2 * ASIDE, LARGE_MOVES)),
    )
