# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the placement of a rigid group."""

from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.auto_keying import insert_auto_keyframes
from stiv.blender.controls.editable import is_keyed
from stiv.blender.controls.object_transform import ObjectTransform, write_transform
from stiv.blender.controls.placement_motion import PlacementMotion
from stiv.blender.controls.transform_locks import restore_locked
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class PlacementWriter:
    """Writes location, and rotation or scale, of the roots of a group."""

    references: tuple[ObjectReference, ...]
    starts: tuple[ObjectTransform, ...]
    motion: PlacementMotion

    def write(self, controls: Floats) -> None:
        """Write centre and rotation vector, or centre and scale factors, (2, 3)."""
        factors = self.motion.factors(controls)
        for ob, start in self._objects():
            motion = self.motion.matrix_of(controls, start.world)
            if np.array_equal(motion, np.eye(4)):
                start.restore(ob)
            else:
                write_transform(ob, start, motion, factors)
                if self.motion.axes is None:
                    restore_locked(ob, start)

    def restore(self) -> None:
        """Restore location, rotation and scale."""
        for ob, start in self._objects():
            start.restore(ob)

    def changed_with_keyframes(self) -> list[str]:
        """Names of the objects with keyframes whose transform has changed since the start."""
        return [ob.name for ob, start in self._objects() if is_keyed(ob) and start.changed(ob)]

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for what has changed since the start."""
        insert_auto_keyframes(context, [(ob, start.changed(ob)) for ob, start in self._objects()])

    def _objects(self) -> list[tuple[bpy.types.Object, ObjectTransform]]:
        return [(reference.find(), start) for reference, start in zip(self.references, self.starts, strict=True)]
