# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing the active shape key of a mesh by the positions that are shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.evaluations import is_edited
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.shape_keys import KeyMix, active_key, following_keys, read_keys, read_mix


@dataclass(frozen=True, eq=False)
class KeyEditing:
    """The active shape key of a mesh at the start of an edit, and the keys that follow it.

    The controls start at the positions of `shown`. The key moves by their motion divided by the key's value, as in
    Blender's own transforms. Keys that are relative to it move along.

    Attributes:
        stored: number and local positions, (m, 3), of the active key, first, and of those that follow it.
        shown: the mix in the evaluation shown now.
    """

    stored: tuple[tuple[int, Singles], ...]
    shown: KeyMix

    @staticmethod
    def of(ob: bpy.types.Object) -> KeyEditing | None:
        """The active shape key of a mesh; None for a mesh without. In Edit Mode as of the last flush."""
        if ob.data.shape_keys is None:
            return None
        return KeyEditing(read_keys(ob, following_keys(ob)), read_mix(ob))

    def shown_positions(self, local: Singles) -> Singles:
        """Local positions that are shown, (m, 3), for local positions of the controls."""
        motion = self.shown.shares[:, None] / (self.shown.value or 1.0) * (local.astype(float) - self.shown.positions)
        return (self.shown.positions + motion).astype(np.float32)

    def active_positions(self, local: Singles) -> Singles:
        """Local positions of the active key, (m, 3), for local positions of the controls."""
        return self._moved(local)[0][1]

    def write(self, ob: bpy.types.Object, local: Singles) -> None:
        """Write the keys for local positions of the controls, (m, 3), outside Edit Mode."""
        _write_keys(ob, self._moved(local))

    def restore(self, ob: bpy.types.Object) -> None:
        """Write the original keys. In Edit Mode the active one is left to the caller."""
        _write_keys(ob, self.stored)

    def check(self, ob: bpy.types.Object) -> None:
        """Raise SceneChangedError if another key is active, or keys were added or removed."""
        if [number for number, _ in self.stored] != following_keys(ob):
            raise SceneChangedError(f"{ob.name} has another active shape key")

    def deformation(self, ob: bpy.types.Object, frame: Floats, evaluation: str) -> stiv.Deformation | None:
        """Deformation from the controls to the cage of an evaluation in world space; None for the identity."""
        mix = read_mix(ob, evaluation)
        factors = mix.shares / (self.shown.value or 1.0)
        if (factors == 1).all() and np.array_equal(mix.positions, self.shown.positions):
            return None
        rows = np.arange(len(factors) + 1, dtype=np.int32)
        weights = stiv.Weights(rows, rows[:-1], factors, (len(factors), len(factors)))
        start = transform_points(frame, self.shown.positions)
        return stiv.linear(weights, transform_points(frame, mix.positions) - factors[:, None] * start)

    def _moved(self, local: Singles) -> list[tuple[int, Singles]]:
        motion = (local.astype(np.float64) - self.shown.positions) / (self.shown.value or 1.0)
        active = (self.stored[0][1] + motion).astype(np.float32)
        offsets = active - self.stored[0][1]  # in single precision, as Blender adds them to other keys
        return [(self.stored[0][0], active), *((number, points + offsets) for number, points in self.stored[1:])]


def check_keys(ob: bpy.types.Object) -> None:
    """Refuse shape keys of which an edit would not be seen. In Edit Mode as of the last flush. Raises InputError."""
    keys = ob.data.shape_keys
    if keys is None:
        return
    if not keys.use_relative:
        raise InputError(f"{ob.name}: its shape keys are absolute; turn on Relative")
    active = active_key(ob)
    reason = ""
    if getattr(active, "lock_shape", False):
        reason = "is locked; unlock it"
    elif not (mix := read_mix(ob)).shares.any():
        reason = "has no effect; change its vertex group"
        if mix.value == 0:
            reason = "is muted; unmute it" if active.mute else "has value 0; raise it"
    if reason:
        raise InputError(f'{ob.name}: shape key "{active.name}" {reason}')


def _write_keys(ob: bpy.types.Object, positions: Sequence[tuple[int, Singles]]) -> None:
    """Write shape keys. The mesh equals the reference key, and in Edit Mode has copies of all keys."""
    mesh, keys = ob.data, ob.data.shape_keys
    for number, points in positions:
        block = keys.key_blocks[number]
        if len(points) != len(block.data):
            raise SceneChangedError(f"{ob.name} changed its number of vertices")
        block.data.foreach_set("co", points.ravel())
        if block == keys.reference_key and not is_edited(ob):
            mesh.vertices.foreach_set("co", points.ravel())
    if is_edited(ob):
        _write_key_layers(mesh, positions)
    else:
        mesh.update()


def _write_key_layers(mesh: bpy.types.Mesh, positions: Sequence[tuple[int, Singles]]) -> None:
    """Write the copies of shape keys in an edit mesh, from which Blender computes how far the active one moved."""
    edit_mesh = bmesh.from_edit_mesh(mesh)
    for number, points in positions:
        layer = edit_mesh.verts.layers.shape[mesh.shape_keys.key_blocks[number].name]
        for vertex, position in zip(edit_mesh.verts, points.tolist(), strict=True):
            vertex[layer] = position
