# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out by trial whether modifiers leave all positions and the topology of a mesh as they are."""

from collections.abc import Collection, Sequence

import bpy
import numpy as np

from stiv.blender.scene.arrays import Singles
from stiv.blender.scene.mesh_reading import read_cage
from stiv.blender.scene.stack_twin import StackTwin, open_twin

MOVES = (0.0, 0.003, 0.01, 0.1)  # of random trials, in sizes of the mesh


def keep_positions(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str, names: Collection[str]) -> bool:
    """Do these modifiers leave positions and topology as they are, to the last bit, now and after random moves?

    An object in Edit Mode is read as of the last `update_from_editmode`.
    """
    local = read_cage(ob)
    with open_twin(ob, scene, evaluation) as twin:
        limit_subdivision(twin)
        trials = random_moves(local)
        return _agree(twin, names, trials[:1]) and _agree(twin, names, trials[1:])


def limit_subdivision(twin: StackTwin) -> None:
    """Limit subdivisions to one level, which shows the same in less time."""
    for modifier in twin.ob.modifiers:
        if isinstance(modifier, bpy.types.SubsurfModifier):
            modifier.levels = min(modifier.levels, 1)


def _agree(twin: StackTwin, names: Collection[str], trials: Sequence[Singles]) -> bool:
    with_them = [twin.evaluate(local) for local in trials]
    twin.show_modifiers(names, False)
    without = [twin.evaluate(local) for local in trials]
    twin.show_modifiers(names, True)
    return all(a.equals(b) for a, b in zip(with_them, without, strict=True))


def random_moves(local: Singles, sizes: Sequence[float] = MOVES) -> list[Singles]:
    """Positions, (m, 3), after random moves of these sizes, relative to that of the mesh."""
    random, size = np.random.default_rng(1), np.ptp(local, axis=0).max(initial=0.0)
    return [local + np.float32(move * size) * random.uniform(-1, 1, local.shape).astype(np.float32) for move in sizes]
