# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of an edit script, as plain data ready for JSON. The format is described in docs/edit_scripts.md."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any, Literal

Step = dict[str, Any]
Points = Literal["all"] | Sequence[int]


def on_objects(names: Sequence[str]) -> Step:
    """Object Mode with these objects selected, the first one active."""
    return {"mode": "OBJECT", "objects": list(names)}


def on_points(name: str, points: Points = "all") -> Step:
    """Edit Mode of one object with these cage vertices or lattice points selected."""
    return {"mode": "EDIT", "objects": [name], "points": points if points == "all" else [int(i) for i in points]}


def move(selection: Step, value: Sequence[float], repeat: int = 1) -> Step:
    """Translate by `value` (3,), world units, `repeat` times."""
    return {"operator": "move", **selection, "values": {"value": [float(x) for x in value]}, "repeat": repeat}


def contract(selection: Step, steps: int) -> Step:
    """Contract until nothing intersects, in at most `steps` steps."""
    return {"operator": "contract", **selection, "values": {"steps": steps, "until_free": True}}


def expand(selection: Step, shares: Sequence[float]) -> list[Step]:
    """Expand to the rest shape, in these ascending fractions of the way, of which the last is 1."""
    left = [1.0, *(1.0 - share for share in shares)]
    amounts = [1.0 - after / before for before, after in itertools.pairwise(left)]
    return [{"operator": "expand", **selection, "values": {"amount": amount}} for amount in amounts]


def repair(selection: Step) -> Step:
    """Remove the intersections."""
    return {"operator": "repair", **selection}


def rotate(selection: Step, angle: float, axis: Sequence[float], repeat: int = 1) -> Step:
    """Rotate by `angle` radians about the world direction `axis` (3,) through the pivot, `repeat` times."""
    values = {"angle": float(angle), "axis": [float(x) for x in axis]}
    return {"operator": "rotate", **selection, "values": values, "repeat": repeat}


def scale(selection: Step, value: Sequence[float], repeat: int = 1) -> Step:
    """Scale by the factors `value` (3,) about the pivot, `repeat` times."""
    return {"operator": "scale", **selection, "values": {"value": [float(x) for x in value]}, "repeat": repeat}
