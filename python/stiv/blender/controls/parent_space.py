# SPDX-License-Identifier: GPL-3.0-or-later
"""Locations below a parent that keep the world coordinates of locked axes to the last bit."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, invert

NEIGHBORS = np.array(list(itertools.product(range(-2, 3), repeat=3)))  # in units in the last place of each coordinate
MAX_ERROR = 8  # along the free axes, in units in the last place
REACHES = (
    8,
    64,
    512,
)  # the same along the free axes, of the largest coordinate; the next one if the last was too short


@dataclass(frozen=True)
class ParentSpace:
    """How Blender computes an object's place in single precision: `above` times the sum of location and delta.

    above: (4, 4), of the parent and its inverse. delta: (3,).
    """

    above: Singles
    delta: Singles

    def world(self, locations: Singles) -> Singles:
        """Places of locations, (k, 3), rounded in the order of Blender's product of matrices."""
        x, y, z = (locations + self.delta).T[:, :, None]
        a, b, c, d = self.above[:3].T
        places: Singles = (x * a + y * b) + (z * c + d)
        return places


def read_parent_space(ob: bpy.types.Object) -> ParentSpace | None:
    """The space below an object's parent; None where the object's present place differs from the computed one."""
    if ob.parent is None or ob.parent_type != "OBJECT":
        return None
    above = _product(
        *(as_matrix(each).astype(np.float32) for each in (ob.parent.matrix_world, ob.matrix_parent_inverse))
    )
    space = ParentSpace(above, np.array(ob.delta_location, np.float32))
    here = space.world(np.array([ob.location], np.float32))[0]
    return space if np.array_equal(here, np.array(ob.matrix_world.translation, np.float32)) else None


def _product(first: Singles, second: Singles) -> Singles:
    columns = [(second[0, k] * first[:, 0] + second[1, k] * first[:, 1])
               + (second[2, k] * first[:, 2] + second[3, k] * first[:, 3]) for k in range(4)]  # fmt: skip
    return np.stack(columns, axis=1)


def keep_locked(space: ParentSpace, location: Floats, start: Floats, goal: Floats) -> Singles:
    """The stored location, (3,), near a wanted one whose place keeps the coordinates in which start and goal agree.

    start, goal: world places, (3,). If there is none, the location that comes nearest to it.
    """
    locked: Flags = start == goal
    if not locked.any() or locked.all():
        return location.astype(np.float32)
    tolerance = MAX_ERROR * float(np.spacing(np.float32(np.abs(goal).max())))
    for reach in REACHES:
        candidates = _candidates(space, location, ~locked, reach)
        errors = np.abs(space.world(candidates).astype(np.float64) - goal)
        along = errors[:, ~locked].max(axis=1)
        off = np.where(along > tolerance, np.inf, errors[:, locked].max(axis=1))
        best = np.lexsort([along, off])[0]
        if off[best] == 0:
            break
    return np.asarray(candidates[best])


def _candidates(space: ParentSpace, location: Floats, free: Flags, reach: int) -> Singles:
    inverse = invert(space.above[:3, :3].astype(np.float64))
    unit = float(np.spacing(np.float32(np.abs(location).max())))
    steps = np.concatenate(
        [inverse[:, axis] * unit * np.arange(-reach, reach + 1)[:, None] for axis in np.flatnonzero(free)]
    )
    nearest = (location + steps).astype(np.float32)
    units = np.spacing(np.abs(nearest))
    found: Singles = (nearest[:, None] + NEIGHBORS * units[:, None]).astype(np.float32).reshape(-1, 3)
    return found
