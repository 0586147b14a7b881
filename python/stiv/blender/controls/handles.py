# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of a mesh as handles, which the others follow: Laplacian and as-rigid-as-possible editing of a cage."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.cage import cage_writer, open_cage, selected_vertices, subdivision_in
from stiv.blender.controls.control_set import Part, Writer
from stiv.blender.controls.control_weights import axes_of_weights, control_weights, pinned_directions
from stiv.blender.controls.joined_seams import TiedWriter, copied, joined_rows, seam_note
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.points import PointGoal, point_weights
from stiv.blender.scene.arrays import Flags, Floats, Indices, transform_points
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.mesh_reading import read_triangles
from stiv.blender.scene.vertex_groups import group_weights
from stiv.blender.settings import EditSettings, Handles
from stiv.seams import Seams


def soft_parts(
    mover: Mover, surfaces: tuple[int, ...], evaluations: Sequence[str], scene: bpy.types.Scene, settings: EditSettings
) -> list[Part]:
    """A mesh object moved by handles, as a part; none where nothing in Edit Mode holds it.

    Its surfaces were read in these evaluations.

    The shape that it has now is the one it keeps as far as the handles let it. Raises InputError where it cannot be
    changed or followed, or has no handle.
    """
    ob = mover.reference.find()
    frame, local = open_cage(ob)
    chosen = settings.handles.get(ob.name, Handles())
    limits = control_weights(ob, settings)
    triangles = read_triangles(ob.data)[0]
    tied = mesh_seams(local, triangles)
    found = _find_handles(ob, mover, chosen, limits.given, tied)
    if len(found.vertices) == 0:
        _check_none(ob, chosen)
        return []
    rest = transform_points(frame, local if tied is None else local[tied.first])
    make = stiv.laplacian if settings.deformation(ob.name) == "laplacian" else stiv.arap
    pull = chosen.pull * found.strength if chosen.pull > 0 else None
    mesh = make(rest, joined_rows(triangles, tied), found.vertices, fixed=found.fixed, pull=pull)
    cage = stiv.stored_mesh(mesh, frame)
    writer = cage_writer(mover.reference, ob, frame, local, settings, limits)
    subdivision = subdivision_in(ob, scene, writer, evaluations)
    shown = cage if tied is None else copied(cage, tied)
    others = settings.weight(False) if mover.selected else 1.0
    given, controls = found.given, rest[found.vertices]
    weights = point_weights(found.moving, settings.weight(True), others, given)
    origin = None if ob.mode == "EDIT" else frame[:3, 3]
    return [Part(
        (ob.name,), "soft", surfaces, shown if subdivision is None else stiv.compose(subdivision, shown),
        controls, weights, given, frame,
        PointGoal(found.moving, controls, None, origin, None, pinned_directions(given, limits.directions)),
        HandleWriter(cage, writer if tied is None else TiedWriter(writer, tied)), note=found.note,
        weight_axes=axes_of_weights(given, limits.directions),
    )]  # fmt: skip


@dataclass(frozen=True)
class HandleWriter:
    """Writes the cage that handles give."""

    cage: stiv.Deformation
    writer: Writer

    def write(self, controls: Floats) -> None:
        """Write the cage for world positions of the handles, (m, 3)."""
        self.writer.write(self.cage.surface(controls))

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is by now."""
        self.writer.restore()


@dataclass(frozen=True)
class _FoundHandles:
    """Vertices that are handles, (m,), how strongly each pulls, which move with the goal, and what is held in place.

    Vertices are those of the mesh with its seams joined. `given`, (m,) or (m, 3): the most response that each may have.
    `note`: of seams that are selected in part.
    """

    vertices: Indices
    strength: Floats
    moving: Flags
    fixed: Indices
    given: Floats
    note: str


def _find_handles(
    ob: bpy.types.Object, mover: Mover, chosen: Handles, given: Floats, tied: Seams | None
) -> _FoundHandles:
    regions = {name: group_weights(ob, name, "a handle") for name in chosen.groups}
    strength, moving = _strengths(ob, mover, regions)
    held = np.asarray((given == 0).reshape(len(given), -1).all(axis=1))
    if chosen.anchor:
        held |= group_weights(ob, chosen.anchor, "the anchor") > 0
    note = "" if tied is None else seam_note(ob.name, moving, tied)
    if tied is not None:  # a seam is a handle where one of its vertices is, and held likewise
        strength, given = _most(strength, tied), -_most(-given, tied)
        moving, held = _most(moving, tied), _most(held, tied)
    is_handle = (strength > 0) & ~held
    fixed = held if chosen.rest == "follows" else ~is_handle
    vertices = np.flatnonzero(is_handle).astype(np.int32)
    held_vertices = np.flatnonzero(fixed).astype(np.int32)
    return _FoundHandles(vertices, strength[vertices], moving[vertices], held_vertices, given[vertices], note)


def _most(values: NDArray[Any], tied: Seams) -> NDArray[Any]:
    """The largest of the values, (n, ...), on each joined vertex, (k, ...)."""
    largest = values[tied.first]
    np.maximum.at(largest, tied.index, values)
    return largest


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
