# SPDX-License-Identifier: GPL-3.0-or-later
"""Approximate Jacobian of a modifier stack: each evaluated vertex follows one vertex of the mesh, in its own frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from mathutils.kdtree import KDTree
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Flags, Floats, Indices, Singles
from stiv.blender.scene.stack_twin import EvaluatedStack, StackTwin
from stiv.task import Steps, run

PROBE = np.array([0.36, 0.48, 0.8])  # direction in which moments move all vertices
HALVINGS = (1.0, 1 / 8, 1 / 64)  # of the step of differences, if the topology changes


def find_anchors(twin: StackTwin, start: EvaluatedStack, local: Singles, step: float) -> Indices:
    """The vertex of the mesh, (m, 3), that each evaluated vertex follows, (n,).

    The rest positions travel through the modifiers as an attribute; where attributes are dropped, they are measured.
    step: of the measurement, in local units.
    """
    twin.write(local)
    carried = twin.carried(local)
    if carried is not None and len(carried) == len(start.positions):
        return _nearest(carried, local)
    return _nearest(_measured(twin, start, local, step), local)


def find_frames(evaluate: Callable[[Floats], Floats | None], controls: Floats, step: float) -> Floats | None:
    """How each evaluated vertex moves if all controls, (m, 3), move along each axis, (n, 3, 3); None if unknown.

    evaluate: world positions, (n, 3), or None where the topology differs. step: of central differences.
    """
    return run(find_frames_steps(evaluate, controls, step))


def find_frames_steps(
    evaluate: Callable[[Floats], Floats | None], controls: Floats, step: float
) -> Steps[Floats | None]:
    """Steps of `find_frames`, which give a turn after each axis."""
    columns: list[Floats | None] = []
    for axis in np.eye(3):
        columns.append(_difference(evaluate, controls, axis * step))
        yield None
    found = [column for column in columns if column is not None]
    return np.stack(found, axis=2) if len(found) == 3 else None


def _difference(evaluate: Callable[[Floats], Floats | None], controls: Floats, move: Floats) -> Floats | None:
    """Derivative of all positions along a move, (3,), times its direction; None if the topology changes."""
    length = float(np.linalg.norm(move))
    for shortening in HALVINGS:
        ends = [evaluate(controls + sign * shortening * move) for sign in (1, -1)]
        if ends[0] is not None and ends[1] is not None:
            derivative: Floats = (ends[0] - ends[1]) / (2 * shortening * length)
            return derivative
    return None


def _measured(twin: StackTwin, start: EvaluatedStack, local: Singles, step: float) -> Floats:
    """Rest positions, (n, 3), from the response to moves of each vertex in proportion to 1 and its coordinates."""
    size = float(np.abs(local).max(initial=0.0)) or 1.0
    scales = [np.ones(len(local)), *(local.T / size)]
    moves = [twin.evaluate((local + step * np.outer(scale, PROBE)).astype(np.float32)) for scale in scales]
    if not all(each.corresponds_to(start) for each in moves):
        return np.zeros((len(start.positions), 3))
    whole, *others = (each.positions.astype(np.float64) - start.positions for each in moves)
    norm = (whole**2).sum(axis=1) + 1e-30
    return np.stack([(other * whole).sum(axis=1) / norm * size for other in others], axis=1)


def _nearest(rest: NDArray[Any], local: Singles) -> Indices:
    """The nearest vertex, (m, 3), to each rest position, (n, 3)."""
    found, exact = _equal(rest.astype(np.float32), local)
    tree = KDTree(len(local))
    for number, point in enumerate(local.tolist()):
        tree.insert(point, number)
    tree.balance()
    for row in np.flatnonzero(~exact).tolist():
        found[row] = tree.find(rest[row].tolist())[1]
    return found


def _equal(rest: Singles, local: Singles) -> tuple[Indices, Flags]:
    """For each rest position a vertex in exactly the same place, and whether there is one."""
    keys, wanted = _keys(local), _keys(rest)
    order = np.argsort(keys, kind="stable")
    found = order[np.searchsorted(keys[order], wanted).clip(max=len(keys) - 1)].astype(np.int32)
    return found, (local[found] == rest).all(axis=1)


def _keys(points: Singles) -> NDArray[np.uint64]:
    """Equal numbers for equal points, (n, 3)."""
    bits = np.ascontiguousarray(points + np.float32(0)).view(np.uint32).astype(np.uint64)
    return bits @ np.array([73856093, 19349663, 83492791], np.uint64)
