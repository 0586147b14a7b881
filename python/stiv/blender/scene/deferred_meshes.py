# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that Blender computes only when they are read: it defers subdivision at the end of a stack.

A first subdivision takes 30 ms for a cage of 500 vertices. So it is done in steps, and once for all objects that show
one mesh through equal modifiers.
"""

from __future__ import annotations

from collections.abc import Hashable

import bpy

from stiv.blender.scene.evaluations import SHOWN, is_visible
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.scene.references import ObjectReference
from stiv.task import Steps, Turns

# Modifiers whose result depends on the mesh and their own settings alone, unless these refer to something else.
SELF_CONTAINED = frozenset({"SUBSURF", "MIRROR", "ARRAY", "SOLIDIFY", "BEVEL", "TRIANGULATE", "WELD", "EDGE_SPLIT"})
Settings = tuple[Hashable, ...]


def compute_meshes_steps(context: bpy.types.Context) -> Steps[None]:
    """Steps in which Blender computes the meshes of all visible objects; of those with equal meshes, one."""
    turns, known = Turns(), set[Settings]()
    for reference in _visible_meshes(context):
        shown = reference.find().evaluated_get(context.evaluated_depsgraph_get())
        key = mesh_key(shown)
        if key is None or key not in known:
            len(shown.data.polygons)
        if key is not None:
            known.add(key)
        yield from turns.take()


class EqualMeshes:
    """Evaluated meshes of one evaluation, of which equal ones are computed once; valid until it is evaluated again."""

    def __init__(self, depsgraph: bpy.types.Depsgraph) -> None:
        self._depsgraph = depsgraph
        self._known: dict[Settings, bpy.types.Object] = {}

    def representative(self, shown: bpy.types.Object) -> bpy.types.Object:
        """An evaluated object whose mesh equals this one's: the first that was asked for."""
        key = mesh_key(shown)
        if key is None:
            return shown
        if key not in self._known:  # that of an instance ends with the next instance
            self._known[key] = shown.original.evaluated_get(self._depsgraph)
        return self._known[key]


def _visible_meshes(context: bpy.types.Context) -> list[ObjectReference]:
    """Objects that show meshes with modifiers, themselves or as instances; Blender's list ends with the next step."""
    instances = OpenEvaluations(context).instances(SHOWN, lambda owner: is_visible(context, owner))
    sources = (instance.object.original for instance, _, _ in instances)
    meshes = (ob for ob in sources if ob.type == "MESH" and len(ob.modifiers))  # texts are shown as meshes too
    return list(dict.fromkeys(map(ObjectReference.of, meshes)))


def mesh_key(shown: bpy.types.Object) -> Settings | None:
    """Equal for evaluated objects in Object Mode whose evaluated meshes are equal; None if that is not certain."""
    original = shown.original
    mesh = original.data
    if not isinstance(mesh, bpy.types.Mesh) or mesh.is_editmode or mesh.shape_keys or original.mode != "OBJECT":
        return None
    stack = [_settings(each) for each in shown.modifiers]
    return None if None in stack else (mesh.session_uid, *stack)


def _settings(modifier: bpy.types.Modifier) -> Settings | None:
    """All settings of a modifier; None if it may depend on something else."""
    if modifier.type not in SELF_CONTAINED or getattr(modifier, "profile_type", "") == "CUSTOM":
        return None  # a custom profile has points, which are not compared
    found: list[Hashable] = [modifier.type]
    for prop in modifier.bl_rna.properties:
        if prop.is_readonly or prop.identifier == "name":
            continue
        value = getattr(modifier, prop.identifier)
        if prop.type == "COLLECTION" or (prop.type == "POINTER" and value is not None):
            return None
        found.append(tuple(value) if getattr(prop, "is_array", False) else _plain(value))
    return tuple(found)


def _plain(value: object) -> Hashable:
    return frozenset(value) if isinstance(value, set) else value
