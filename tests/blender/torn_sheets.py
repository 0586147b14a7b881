# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet with copies of the vertices on a seam, and independent counts of the faces that cut each other there."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from building import add, add_modifier, edit_mode, evaluated, mesh, select

import stiv

LEFT = [(-1, 0, 0), (0, 0, 0), (0, 1, 0), (-1, 1, 0)]
RIGHT = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def torn_sheet() -> Any:
    """Two quads with copies of the vertices that they share."""
    return add("Sheet", mesh("Sheet", [*LEFT, *RIGHT], [(0, 1, 2, 3), (4, 5, 6, 7)]))


def rig_halves(sheet: Any) -> Any:
    """A rig, in Object Mode, with a bone for each half of the sheet, "A" and "B"."""
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(rig)
    edit_mode(rig)
    for name, x in (("A", -0.5), ("B", 0.5)):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = (x, 0.5, 0), (x, 1.5, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, vertices in (("A", range(4)), ("B", range(4, 8))):
        sheet.vertex_groups.new(name=name).add(list(vertices), 1.0, "REPLACE")
    add_modifier(sheet, "ARMATURE", object=rig)
    select(rig)
    return rig


def add_key(ob: Any, name: str, moved: dict[int, Sequence[float]]) -> Any:
    """A key with other places of some vertices."""
    if ob.data.shape_keys is None:
        ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name=name)
    for vertex, place in moved.items():
        key.data[vertex].co = place
    key.value = 0.0
    return key


def cutting_faces(ob: Any) -> int:
    """Number of faces that Blender shows intersecting, once vertices in the same place are one."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    corners = np.array([tuple(triangle.vertices) for triangle in shown.loop_triangles])
    faces = np.array([triangle.polygon_index for triangle in shown.loop_triangles])
    points, same = np.unique(np.round(evaluated(ob), 5), axis=0, return_inverse=True)
    return len(np.unique(faces[stiv.find_intersections(points, same.reshape(-1)[corners].astype(np.int32))]))


def named(note: str) -> int:
    """The number of faces that the note on the sheet names."""
    found = re.fullmatch(r"Sheet: (\d+) faces at torn seams cut each other; use Merge by Distance", note)
    assert found, note
    return int(found[1])


CROSSING = {4: (-0.5, 0, -0.5), 7: (-0.5, 1, 0.5)}
PARTING = {4: (0.2, 0, 0.1), 7: (0.3, 1, 0)}
