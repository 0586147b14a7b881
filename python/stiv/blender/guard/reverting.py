# SPDX-License-Identifier: GPL-3.0-or-later
"""Back to an earlier state of the scene: controls, poses and shape key values of all objects."""

import bpy

from stiv import InputError
from stiv.blender.guard.scene_state import ObjectState, SceneState, read_object
from stiv.blender.scene.errors import SceneChangedError


def revert(context: bpy.types.Context, state: SceneState) -> tuple[str, ...]:
    """Give every object of a state the controls it had; the names of those that differed.

    Objects that came since then stay as they are; those that were removed stay away. Raises InputError naming an object
    whose vertices, parent or rotation mode are others now, before anything is changed.
    """
    differing = [former for former in state.values() if _differs(former)]
    for former in differing:
        ob = former.reference.find()
        if former.placement != (now := read_object(ob)).placement:
            former.restore_placement()
        if former.posture != now.posture:
            former.posture.restore(ob)
        if not former.has_points_of(now):
            former.restore_points()
    context.view_layer.update()
    return tuple(former.reference.name for former in differing)


def _differs(former: ObjectState) -> bool:
    try:
        now = read_object(former.reference.find())
    except SceneChangedError:  # removed since then
        return False
    if now.kind != former.kind:
        raise InputError(f'object "{former.reference.name}": its structure has changed; use Undo instead')
    same = former.placement == now.placement and former.posture == now.posture
    return not (same and former.has_points_of(now))
