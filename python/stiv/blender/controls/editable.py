# SPDX-License-Identifier: GPL-3.0-or-later
"""Refuses objects that cannot be edited, or whose changes would not be visible, with a way out."""

from typing import Any

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.animation_curves import driven_paths, keyed_paths
from stiv.blender.scene.arrays import as_matrix
from stiv.blender.scene.dependencies import is_enabled
from stiv.blender.scene.references import type_name

TRANSFORM_PATHS = ("location", "rotation", "scale", "delta_")
REASONS = {
    "animated": "its transform is animated; clear the animation",
    "driven": "its transform is driven; delete the drivers",
    "constraint": 'constraint "{other}" determines its transform; disable it',
    "linked": "it is linked; make a library override of it",
    "linked data": "its {kind} is linked from another file; make it local",
    "metaball": "metaballs cannot move; convert it to a mesh",
    "overridden data": "its {kind} is a library override; make it local",
    "shared data": 'its {kind} is shared with "{other}"; make it single user',
    "system override": "its override is not editable; make it editable in the Outliner",
    "zero scale": "its scale is zero; change it",
}


def check_placement(ob: bpy.types.Object, may_be_keyed: bool = False) -> None:
    """Refuse an object whose transform cannot be edited. Raises InputError.

    may_be_keyed: accept keyframes of the transform. As with Blender's own tools, a change then lasts until the frame
    changes, or until it is keyed.
    """
    if ob.library is not None:
        raise _refusal(ob, "linked")
    if ob.override_library is not None and ob.override_library.is_system_override:
        raise _refusal(ob, "system override")
    _check_scale(ob)
    if any(path.startswith(TRANSFORM_PATHS) for path in driven_paths(ob)):
        raise _refusal(ob, "driven")
    if not may_be_keyed:
        check_unkeyed(ob)
    check_unconstrained(ob)
    if ob.type == "META":
        raise _refusal(ob, "metaball")


def check_unkeyed(ob: bpy.types.Object) -> None:
    """Refuse an object whose keyframes would reset its transform at the next frame. Raises InputError."""
    if is_keyed(ob):
        raise _refusal(ob, "animated")


def is_keyed(ob: bpy.types.Object) -> bool:
    """Has the transform of an object keyframes?"""
    return any(path.startswith(TRANSFORM_PATHS) for path in keyed_paths(ob))


def check_unconstrained(ob: bpy.types.Object) -> None:
    """Refuse an object with active constraints. Raises InputError."""
    for constraint in ob.constraints:
        if is_enabled(constraint) and constraint.influence > 0:
            raise _refusal(ob, "constraint", other=constraint.name)


def check_data(ob: bpy.types.Object) -> None:
    """Refuse an object whose vertices or points cannot be edited. Raises InputError."""
    kind = type_name(ob)
    if ob.data.override_library is not None:
        raise _refusal(ob, "overridden data", kind=kind)
    if ob.data.library is not None:
        raise _refusal(ob, "linked data", kind=kind)
    _check_scale(ob)
    if ob.type != "MESH":
        others = [other for other in bpy.data.objects if other.data == ob.data and other != ob]
        if others:
            raise shared_data_error(ob, others[0])


def shared_data_error(ob: bpy.types.Object, other: bpy.types.Object) -> InputError:
    """The error for data that is shared with another object."""
    return _refusal(ob, "shared data", kind=type_name(ob), other=other.name)


def _refusal(ob: bpy.types.Object, reason: str, **names: Any) -> InputError:
    return InputError(f"{ob.name}: {REASONS[reason].format(**names)}")


def _check_scale(ob: bpy.types.Object) -> None:
    lengths = np.linalg.svd(as_matrix(ob.matrix_world)[:3, :3], compute_uv=False)
    if not np.isfinite(lengths).all() or lengths[-1] <= 1e-6 * lengths[0]:
        raise _refusal(ob, "zero scale")
