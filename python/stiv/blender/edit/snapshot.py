# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of the scene at the start of an edit: surfaces, control sets and settings."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import bpy

from stiv import InputError
from stiv.blender.controls.control_reading import make_control_sets_steps
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.editable import is_keyed
from stiv.blender.controls.mirrored_controls import mirror_controls
from stiv.blender.controls.participants import moves_surface, nothing_movable, nothing_selected
from stiv.blender.edit.sessions import assemble_with_controls, stack_controls
from stiv.blender.scene.animation_curves import is_animated
from stiv.blender.scene.arrays import Floats, Indices, as_matrix, digest
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.deferred_meshes import compute_meshes_steps
from stiv.blender.scene.dependencies import find_dependents
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.exclusions import drop_stale
from stiv.blender.scene.guarded_evaluations import Guard, read_guarded_scene
from stiv.blender.scene.static_reading import prepare_static_meshes_steps, read_static_meshes
from stiv.blender.scene.strand_reading import surface_of
from stiv.blender.settings import EditSettings
from stiv.task import Steps, Turns

Names = tuple[str, str]


@dataclass(frozen=True)
class EditSnapshot:
    """A scene read for an edit. It holds no references to Blender's data, which undo would invalidate.

    Attributes:
        assembly: all surfaces, with the obstacles beside them.
        control_sets: the moving and yielding ones, in the order of the controls.
        settings: without stale exclusions.
        guard: the evaluations that stay free of intersections.
        hidden: number of hidden objects, which do not participate.
        dropped_exclusions: message about excluded pairs that are stale; "" if there are none.
        placements: of all objects of the view layer, (4, 4) each.
        frame: the scene's when it was read.
        carried: names of the objects whose strands follow the moving objects, and are therefore no obstacles.
        cutting: pairs of names of selected objects that cut each other and move as one; None where all move alone.
        may_touch: whether objects that move may touch others from the start.
    """

    assembly: Assembly
    control_sets: tuple[ControlSet, ...]
    settings: EditSettings
    guard: Guard
    hidden: int
    dropped_exclusions: str
    placements: tuple[Floats, ...]
    carried: frozenset[str]
    frame: float
    cutting: frozenset[Names] | None = None
    may_touch: bool = False

    @cached_property
    def start(self) -> Floats:
        """The controls of all control sets, (m, 3)."""
        return stack_controls([each.controls for each in self.control_sets])

    @cached_property
    def digest(self) -> str:
        """Equal for edits that start with the same controls, moving surfaces and placements."""
        points = self.assembly.positions[find_moving_vertices(self.assembly, self.control_sets)]
        return digest(*(each.controls for each in self.control_sets), points, *self.placements).hex()


def take_snapshot_steps(
    context: bpy.types.Context,
    settings: EditSettings,
    kind: str,
    participants: Sequence[Participant],
    adapt: Callable[[ControlSet], ControlSet],
    obstacles: Collection[str],
    cutting: frozenset[Names] | None = None,
) -> Steps[EditSnapshot]:
    """Steps that read the scene for an edit of this kind, and change nothing. Raise InputError.

    adapt: may replace each control set. obstacles: names of objects that are obstacles beside the surface. cutting: see
    `EditSnapshot`.
    """
    if settings.guard == "auto" and any(_is_animated(context, each) for each in participants):
        settings = replace(settings, guard="viewport")  # the render shows the keyframes, not what has changed since
    turns = Turns()
    yield from compute_meshes_steps(context)
    if obstacles:
        yield from prepare_static_meshes_steps(context, obstacles)
    frame = context.scene.frame_current_final
    scene, guard = read_guarded_scene(context, settings, strands=True, static=obstacles)
    beside = read_static_meshes(context, obstacles, frozenset(guard.evaluations)) if obstacles else ()
    solid = [mesh for mesh in scene.meshes if mesh.strands is None]
    yield from turns.take()
    found, groups = yield from make_control_sets_steps(context, participants, solid, settings, kind, cutting or ())
    control_sets = tuple(adapt(mirror_controls(each, solid)) for each in found)
    divided = next((each.posed.meshes for each in control_sets if each.posed is not None), solid)
    if not any(each.rule.moves for each in control_sets):
        raise _nothing_moves(participants, solid)
    yield from turns.take()
    moving = {each.reference.name for each in participants}.union(
        *(group.members for group in groups),
        (divided[index].owner.name for control_set in control_sets for index in control_set.surfaces),
    )
    still, carried = _static_strands(context, scene.meshes, moving)
    meshes = [*divided, *still]
    assembly = assemble_with_controls(meshes, control_sets, [group.members for group in groups], settings)
    assembly = replace(assembly, obstacles=beside)
    excluded, dropped_exclusions = drop_stale(settings.excluded, solid)
    placements = tuple(as_matrix(ob.matrix_world) for ob in context.view_layer.objects)
    chosen = replace(settings, excluded=excluded)
    return EditSnapshot(
        assembly, control_sets, chosen, guard, scene.hidden, dropped_exclusions, placements, carried, frame, cutting
    )  # fmt: skip


def _is_animated(context: bpy.types.Context, participant: Participant) -> bool:
    """Do keyframes determine what the edit changes?"""
    ob = participant.reference.find()
    if participant.role == "rigid":
        return is_keyed(ob) and moves_surface(context, [ob])
    return participant.role == "bones" and is_animated(ob)


def _nothing_moves(participants: Sequence[Participant], solid: Sequence[VisibleMesh]) -> InputError:
    if any(each.role != "rigid" for each in participants):
        return nothing_selected()
    shown = {mesh.owner.name for mesh in solid}
    names = [each.reference.name for each in participants if each.selected]
    return nothing_movable([name for name in names if name not in shown])


def find_moving_vertices(assembly: Assembly, control_sets: Sequence[ControlSet]) -> Indices:
    """Vertices of the surface that follow the controls."""
    return assembly.vertices_of([index for each in control_sets for index in each.surfaces])


def _static_strands(
    context: bpy.types.Context, meshes: Sequence[VisibleMesh], moving: set[str]
) -> tuple[list[VisibleMesh], frozenset[str]]:
    """The strands that do not move, and the names of the objects whose strands follow the moving objects."""
    strands = [mesh for mesh in meshes if mesh.strands is not None]
    if not strands:
        return [], frozenset()
    follow = find_dependents(list(context.view_layer.objects), moving)
    carried = frozenset(mesh.owner.name for mesh in strands if _carriers(mesh) & follow)
    return [mesh for mesh in strands if mesh.owner.name not in carried], carried


def _carriers(strands: VisibleMesh) -> set[str]:
    surface = surface_of(strands.owner.find())
    return {strands.owner.name, strands.source} | ({surface.name} if surface is not None else set())
