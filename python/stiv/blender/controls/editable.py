# SPDX-License-Identifier: GPL-3.0-or-later
"""May an object be changed, and would the change be what the user sees? Each refusal names the ways out."""

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.animation_curves import controlled_paths
from stiv.blender.scene.arrays import as_matrix

TRANSFORM_PATHS = ("location", "rotation", "scale", "delta_")


def check_placement(ob: bpy.types.Object) -> None:
    """Refuse an object whose location, rotation and scale do not decide where it stands. Raises InputError."""
    _check_own_placement(ob)
    _check_size(ob)
    if any(path.startswith(TRANSFORM_PATHS) for path in controlled_paths(ob)):
        raise InputError(
            f'object "{ob.name}": its placement is animated or driven; clear or bake that, or make it an obstacle'
        )
    check_unconstrained(ob)
    if ob.type == "META":
        raise InputError(f'object "{ob.name}": metaballs cannot be moved; convert it to a mesh, or make it an obstacle')


def check_unconstrained(ob: bpy.types.Object) -> None:
    """Refuse an object with constraints in force. Raises InputError."""
    for constraint in ob.constraints:
        if not constraint.mute and constraint.influence > 0:
            raise InputError(
                f'object "{ob.name}", constraint "{constraint.name}": decides the placement; apply or disable it, '
                "or make the object an obstacle"
            )


def check_data(ob: bpy.types.Object) -> None:
    """Refuse an object whose vertices or points cannot be written, or would not show. Raises InputError."""
    kind = ob.type.lower()
    if ob.data.override_library is not None:
        raise InputError(f'object "{ob.name}": its {kind} is a library override; make it local or an obstacle')
    _check_not_linked(ob, ob.data, kind)
    _check_size(ob)
    others = [other.name for other in bpy.data.objects if other.data == ob.data and other != ob]
    if others:
        raise InputError(
            f'object "{ob.name}": its {kind} is shared with object "{others[0]}", which would change too; '
            "make it single user, or make the object an obstacle"
        )
    keys = ob.data.shape_keys
    if keys is not None and len(keys.key_blocks) > 1:
        raise InputError(
            f'object "{ob.name}", shape key "{keys.key_blocks[1].name}": hides changes of the {kind}; apply or remove '
            "the shape keys, let the object respond rigidly, or make it an obstacle"
        )


def _check_not_linked(ob: bpy.types.Object, data: bpy.types.ID, kind: str) -> None:
    if data.library is not None:
        raise InputError(f'object "{ob.name}": its {kind} is linked from another file; make it local or an obstacle')


def _check_own_placement(ob: bpy.types.Object) -> None:
    """A library override has a placement of its own, unless Blender alone may change it."""
    if ob.library is not None:
        raise InputError(f'object "{ob.name}": it is linked; make a library override of it, or an obstacle')
    if ob.override_library is not None and ob.override_library.is_system_override:
        raise InputError(f'object "{ob.name}": its override is not editable; make it editable in the Outliner')


def _check_size(ob: bpy.types.Object) -> None:
    lengths = np.linalg.svd(as_matrix(ob.matrix_world)[:3, :3], compute_uv=False)
    if not np.isfinite(lengths).all() or lengths[-1] <= 1e-6 * lengths[0]:
        raise InputError(f'object "{ob.name}": its scale is zero; give it a size, or make it an obstacle')
