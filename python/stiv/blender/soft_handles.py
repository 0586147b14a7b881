# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of a mesh as handles, which the others follow: Laplacian and as-rigid-as-possible editing of a cage."""

from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.arrays import Flags, Floats, Indices, transform_points
from stiv.blender.cage import CageWriter, cage_writer, open_cage, selected_vertices, subdivision_of
from stiv.blender.control_weights import control_weights
from stiv.blender.mesh_reading import read_triangles
from stiv.blender.movers import Mover
from stiv.blender.parts import Part
from stiv.blender.points import PointGoal, point_weights
from stiv.blender.settings import EditSettings, Handles
from stiv.blender.vertex_groups import group_weights


def soft_parts(mover: Mover, surfaces: tuple[int, ...], scene: bpy.types.Scene, settings: EditSettings) -> list[Part]:
    """A mesh object moved by handles, as a part; none where nothing in Edit Mode holds it.

    The shape that it has now is the one it keeps as far as the handles let it. Raises InputError where it cannot be
    changed or followed, or has no handle.
    """
    ob = mover.reference.find()
    frame, local = open_cage(ob)
    chosen = settings.handles.get(ob.name, Handles())
    given = control_weights(ob, settings)
    found = _find_handles(ob, mover, chosen, given)
    if len(found.vertices) == 0:
        _check_none(ob, chosen)
        return []
    rest = transform_points(frame, local)
    make = stiv.laplacian if settings.deformation(ob.name) == "laplacian" else stiv.arap
    pull = chosen.pull * found.strength if chosen.pull > 0 else None
    mesh = make(rest, read_triangles(ob.data)[0], found.vertices, fixed=found.fixed, pull=pull)
    cage = stiv.stored_mesh(mesh, frame)
    writer = cage_writer(mover.reference, ob, frame, local, settings)
    subdivision = subdivision_of(ob, scene, writer)
    others = settings.weight(False) if mover.selected else 1.0
    given, controls = given[found.vertices], rest[found.vertices]
    weights = point_weights(found.moving, settings.weight(True), others, given)
    origin = None if ob.mode == "EDIT" else frame[:3, 3]
    return [Part(
        (ob.name,), "soft", surfaces, cage if subdivision is None else stiv.compose(subdivision, cage),
        controls, weights, given, frame, PointGoal(found.moving, controls, None, origin),
        HandleWriter(cage, writer),
    )]  # fmt: skip


@dataclass(frozen=True)
class HandleWriter:
    """Writes the cage that handles give."""

    cage: stiv.Deformation
    writer: CageWriter

    def write(self, controls: Floats) -> None:
        """Write the cage for world positions of the handles, (m, 3)."""
        self.writer.write(self.cage.surface(controls))

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is by now."""
        self.writer.restore()


@dataclass(frozen=True)
class _FoundHandles:
    """Vertices that are handles, (m,), how strongly each pulls, which move with the goal, and what is held in place."""

    vertices: Indices
    strength: Floats
    moving: Flags
    fixed: Indices


def _find_handles(ob: bpy.types.Object, mover: Mover, chosen: Handles, given: Floats) -> _FoundHandles:
    regions = {name: group_weights(ob, name, "a handle") for name in chosen.groups}
    strength, moving = _strengths(ob, mover, regions)
    held = given == 0
    if chosen.anchor:
        held |= group_weights(ob, chosen.anchor, "the anchor") > 0
    is_handle = (strength > 0) & ~held
    fixed = held if chosen.rest == "follows" else ~is_handle
    vertices = np.flatnonzero(is_handle).astype(np.int32)
    return _FoundHandles(vertices, strength[vertices], moving[vertices], np.flatnonzero(fixed).astype(np.int32))


def _strengths(ob: bpy.types.Object, mover: Mover, regions: dict[str, Floats]) -> tuple[Floats, Flags]:
    """How strongly each vertex is pulled, 0 where it is no handle, and whether it is one that moves."""
    strength: Floats = np.max([np.zeros(len(ob.data.vertices)), *regions.values()], axis=0)
    if ob.mode == "EDIT":
        selected = selected_vertices(ob, mover.selected)
        return np.where(selected, 1.0, strength), selected
    active = None if ob.vertex_groups.active is None else ob.vertex_groups.active.name
    moving = regions[active] > 0 if active in regions else strength > 0
    return strength, moving & mover.selected


def _check_none(ob: bpy.types.Object, chosen: Handles) -> None:
    if ob.mode == "EDIT":
        return
    if not chosen.groups:
        reason = "its settings name no vertex group as a handle; name one, or select vertices in Edit Mode"
    else:
        reason = f'no vertex of "{chosen.groups[0]}" can be a handle: all are without weight, anchored or pinned'
    raise InputError(f'object "{ob.name}": {reason}; or choose another deformation for it')
