# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles of a mesh: Laplacian and as-rigid-as-possible editing of a cage."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.cage import cage_writer, open_cage, selected_vertices
from stiv.blender.controls.cage_surface import hidden_note, read_surface_steps
from stiv.blender.controls.control_set import ControlSet, Participant, ShownAs, Writer
from stiv.blender.controls.control_weights import axes_of_weights, control_weights, pinned_directions, response_weights
from stiv.blender.controls.joined_seams import SeamWriter, copy_to_seams, join_notes, join_rows, seam_message
from stiv.blender.controls.points import PointGoal
from stiv.blender.controls.shared_meshes import sharing_note
from stiv.blender.scene.arrays import Flags, Floats, Indices, transform_points
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.mesh_reading import read_triangles
from stiv.blender.scene.vertex_groups import group_weights
from stiv.blender.settings import EditSettings, Handles
from stiv.seams import Seams
from stiv.task import run


def make_handle_sets(
    participant: Participant,
    surfaces: tuple[int, ...],
    shown_as: Sequence[ShownAs],
    scene: bpy.types.Scene,
    settings: EditSettings,
) -> list[ControlSet]:
    """Control set of a mesh's handles; empty if none are selected in Edit Mode. `shown_as` says where its `surfaces`
    were read.

    The present shape is the rest shape. Raises InputError if the mesh cannot be edited, has unsupported modifiers, or
    has no handles.
    """
    ob = participant.reference.find()
    frame, local = open_cage(ob)
    chosen = settings.handles.get(ob.name, Handles())
    limits = control_weights(ob, settings)
    triangles = read_triangles(ob.data)[0]
    control_seams = mesh_seams(local, triangles)
    found = _find_handles(ob, participant, chosen, limits.max_weights, control_seams)
    if len(found.vertices) == 0:
        _check_none(ob, chosen)
        return []
    rest = transform_points(frame, local if control_seams is None else local[control_seams.first])
    make = stiv.laplacian if settings.deformation(ob.name) == "laplacian" else stiv.arap
    pull = chosen.pull * found.strength if chosen.pull > 0 else None
    mesh = make(rest, join_rows(triangles, control_seams), found.vertices, fixed=found.fixed, pull=pull)
    cage = stiv.stored_mesh(mesh, frame)
    writer = cage_writer(participant.reference, ob, frame, local, settings)
    surface = run(read_surface_steps(ob, scene, writer, shown_as))
    shown = cage if control_seams is None else copy_to_seams(cage, control_seams)
    whole = surface.of_vertices(shown)
    limited = surface.limited(writer)
    max_weights, controls = found.max_weights, rest[found.vertices]
    weights = response_weights(participant, found.moving, max_weights, settings)
    placed = None if ob.mode == "EDIT" else frame
    return [ControlSet(
        (ob.name,), "soft", surfaces, whole, controls, weights, max_weights, frame,
        PointGoal(found.moving, controls, None, placed, None, pinned_directions(max_weights, limits.directions)),
        HandleWriter(cage, limited if control_seams is None else SeamWriter(limited, control_seams)),
        note=join_notes(sharing_note(ob), hidden_note(ob, shown_as), found.note),
        weight_axes=axes_of_weights(max_weights, limits.directions), observed=surface.observed,
    )]  # fmt: skip


@dataclass(frozen=True)
class HandleWriter:
    """Writes the cage that the handles deform."""

    cage: stiv.Deformation
    writer: Writer

    def write(self, controls: Floats) -> None:
        """Write the cage for world positions of the handles, (m, 3)."""
        self.writer.write(self.cage.surface(controls))

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is now."""
        self.writer.restore()


@dataclass(frozen=True)
class _FoundHandles:
    """Vertices that are handles, (m,), with their stiffness, flags of those that move, and the fixed vertices.

    Vertices are those of the mesh with merged seams. `max_weights`, (m,) or (m, 3): upper bounds of the response
    weights. `note`: message about partly selected seams.
    """

    vertices: Indices
    strength: Floats
    moving: Flags
    fixed: Indices
    max_weights: Floats
    note: str


def _find_handles(
    ob: bpy.types.Object, participant: Participant, chosen: Handles, max_weights: Floats, control_seams: Seams | None
) -> _FoundHandles:
    regions = {name: group_weights(ob, name, "a handle") for name in chosen.groups}
    strength, moving = _strengths(ob, participant, regions)
    held = np.asarray((max_weights == 0).reshape(len(max_weights), -1).all(axis=1))
    if chosen.anchor:
        held |= group_weights(ob, chosen.anchor, "the anchor") > 0
    note = "" if control_seams is None else seam_message(ob.name, moving, control_seams)
    if control_seams is not None:  # a merged vertex is a handle, or fixed, if any of its copies is
        strength, max_weights = (
            _max_over_copies(strength, control_seams),
            -_max_over_copies(-max_weights, control_seams),
        )
        moving, held = _max_over_copies(moving, control_seams), _max_over_copies(held, control_seams)
    is_handle = (strength > 0) & ~held
    fixed = held if chosen.rest == "follows" else ~is_handle
    vertices = np.flatnonzero(is_handle).astype(np.int32)
    held_vertices = np.flatnonzero(fixed).astype(np.int32)
    return _FoundHandles(vertices, strength[vertices], moving[vertices], held_vertices, max_weights[vertices], note)


def _max_over_copies(values: NDArray[Any], control_seams: Seams) -> NDArray[Any]:
    """The maximum of values, (n, ...), over the copies of each merged vertex, (k, ...)."""
    largest = values[control_seams.first]
    np.maximum.at(largest, control_seams.index, values)
    return largest


def _strengths(ob: bpy.types.Object, participant: Participant, regions: dict[str, Floats]) -> tuple[Floats, Flags]:
    """Stiffness of each vertex, 0 if it is not a handle, and flags of the moving handles."""
    strength: Floats = np.max([np.zeros(len(ob.data.vertices)), *regions.values()], axis=0)
    if ob.mode == "EDIT":
        selected = selected_vertices(ob, participant.selected)
        return np.where(selected, 1.0, strength), selected
    active = None if ob.vertex_groups.active is None else ob.vertex_groups.active.name
    moving = regions[active] > 0 if active in regions else strength > 0
    return strength, moving & participant.selected


def _check_none(ob: bpy.types.Object, chosen: Handles) -> None:
    if ob.mode == "EDIT":
        return
    if not chosen.groups:
        reason = "it has no handle; choose a vertex group for it"
    else:
        reason = f'no vertex of "{chosen.groups[0]}" can be a handle; change its weights'
    raise InputError(f"{ob.name}: {reason}")
