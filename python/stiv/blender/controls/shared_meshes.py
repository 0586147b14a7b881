# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of a mesh that several objects share: its vertices are controls of all their surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

import stiv
from stiv.blender.controls.affine_images import affine_images
from stiv.blender.controls.subdivision import identity_deformation
from stiv.blender.scene.arrays import Floats


def other_users(ob: bpy.types.Object) -> list[bpy.types.Object]:
    """The other objects that share an object's mesh."""
    if ob.type != "MESH" or ob.data.users < 2:
        return []
    return [other for other in bpy.data.objects if other.data == ob.data and other != ob]


def sharing_note(ob: bpy.types.Object) -> str:
    """Message about the objects that move along because they share the mesh; "" if there are none."""
    count = len(other_users(ob))
    others = "1 object that shares" if count == 1 else f"{count:,} objects that share"
    return f"{ob.name}: also moves {others} its mesh" if count else ""


def in_frames(surfaces: Sequence[stiv.Deformation | None], maps: Sequence[Floats], count: int) -> stiv.Deformation:
    """Linear deformations of the images of `count` controls under maps, (4, 4), side by side; None: the identity."""
    whole = _side_by_side([_linear_parts(each or identity_deformation(count)) for each in surfaces])
    return stiv.compose(whole, affine_images(count, [np.arange(count, dtype=np.int32)] * len(maps), maps))


def _side_by_side(parts: Sequence[tuple[stiv.Weights, Floats]]) -> stiv.Deformation:
    """Linear deformations with controls of their own."""
    weights = [part[0] for part in parts]
    columns = np.cumsum([0, *(each.shape[1] for each in weights)])
    ends = np.cumsum([0, *(len(each.data) for each in weights)])
    rows = [each.indptr[:-1] + end for each, end in zip(weights, ends, strict=False)]
    whole = stiv.Weights(
        np.append(np.concatenate(rows), ends[-1]).astype(np.int32),
        np.concatenate([each.indices + first for each, first in zip(weights, columns, strict=False)]).astype(np.int32),
        np.concatenate([each.data for each in weights]),
        (sum(each.shape[0] for each in weights), int(columns[-1])),
    )
    return stiv.linear(whole, np.concatenate([offset for _, offset in parts]))


def _linear_parts(deformation: stiv.Deformation) -> tuple[stiv.Weights, Floats]:
    weights, offset = stiv.linear_weights(deformation)
    return weights, np.zeros((weights.shape[0], 3)) if offset is None else offset
