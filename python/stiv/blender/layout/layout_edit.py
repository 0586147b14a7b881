# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects as a rigid scene, and their way back into Blender through a tested edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.editable import check_unkeyed
from stiv.blender.controls.participants import may_have_surface
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.sessions import body_separations, split_controls, stack_controls
from stiv.blender.layout.rigid_scene import Mover, RigidScene
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluations import is_visible
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings

GROUND = "z = 0"
GROUND_SIZE = 100.0  # times the extent of the scene
SAME_SHAPE = 1e-5  # greatest deviation from a rigid motion, in sizes of the surface


class LayoutEdit:
    """Reads objects as movers among the visible scene, and writes their poses.

    Attributes:
        scene: the movers and obstacles; without references to Blender's data.
        assembly: the surfaces that were read.
        without_surface: names of the given objects that have no surface; they stay.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        settings: EditSettings,
        objects: Sequence[bpy.types.Object],
        ground: bool = False,
    ) -> None:
        """Read the scene. ground: the plane z = 0 is an obstacle too, the last mover.

        Raises InputError naming the object: hidden, without collisions, locked, constrained, with keyframes, or
        dependent on others.
        """
        if context.mode != "OBJECT":
            raise InputError("works in Object Mode; leave the present mode")
        movable = [ob for ob in objects if may_have_surface(ob) and is_visible(context, ob)]
        self.without_surface = tuple(ob.name for ob in objects if ob not in movable)
        for ob in movable:
            if settings.role(ob.name) == "ignored":
                raise InputError(f"{ob.name}: it has the role No Collision; choose Automatic")
            check_unkeyed(ob)
        if not movable:
            raise InputError("nothing movable is selected; select an object with a surface")
        self._settings = replace(settings, interference=False, responders="selected", object_response="slide_and_turn")
        self._participants = [Participant(ObjectReference.of(ob), "rigid", True) for ob in movable]
        self._scales: dict[str, tuple[float, ...]] = {}
        self._edit = BlenderEdit.begin_with(context, self._settings, "move", self._participants)
        for each in self._edit.control_sets:
            if each.placed is not None and not _keeps_shape(each):
                raise InputError(f"{each.names[0]}: its shape changes as it moves; use Collision Move")
        self.assembly = self._edit.assembly
        self.scene = _rigid_scene(self._edit, self._settings, ground)

    @property
    def control_sets(self) -> tuple[ControlSet, ...]:
        """One for each mover, except the ground."""
        return self._edit.control_sets

    def has_moved(self, mover: int) -> bool:
        """Does the pose of a mover differ from the start?"""
        return not np.array_equal(self.scene.pose(mover), self.control_sets[mover].controls)

    def write(self) -> None:
        """Write the poses, and test Blender's evaluation as edits do. Raises InputError, with nothing changed."""
        poses = [self.scene.pose(number) for number in range(len(self.control_sets))]
        self._edit.resume_from(stack_controls(poses))
        try:
            reason = self._edit.set_interference(True)
        except BaseException:
            self._edit.restore()
            raise
        if reason:
            self._edit.restore()
            raise InputError(reason)

    def write_scaled(self, context: bpy.types.Context, scene: RigidScene, scale: float) -> None:
        """Scale the objects and write the poses of `scene`, whose movers have this scale. Raises InputError."""
        if scale == 1:
            self.scene = scene
            self.write()
            return
        objects = [bpy.data.objects[each.names[0]] for each in self.control_sets]
        self._scales = {ob.name: tuple(ob.scale) for ob in objects}
        for ob in objects:
            ob.scale *= scale
        context.view_layer.update()
        self._edit = BlenderEdit.begin_with(context, self._settings, "move", self._participants)
        self.scene = scene
        self.write()

    def restore(self) -> None:
        """Restore the objects exactly."""
        self._edit.restore()
        for name, scale in self._scales.items():
            bpy.data.objects[name].scale = scale
        bpy.context.view_layer.update()


def _keeps_shape(control_set: ControlSet) -> bool:
    """Does Blender show the same shape in another place, though modifiers refer to objects that stay?"""
    start = control_set.deformation.surface(control_set.controls)
    size = float(np.ptp(start, axis=0).max(initial=0.0)) or 1.0
    moved = control_set.controls + np.array([[0.4 * size, -0.3 * size, 0.2 * size], [0.3, -0.2, 0.4]])
    try:
        shown = control_set.deformation.surface(moved)
    except stiv.InfeasibleError:
        return False
    return bool(np.abs(shown - stiv.rigid(start).surface(moved)).max(initial=0.0) <= SAME_SHAPE * size)


def _rigid_scene(edit: BlenderEdit, settings: EditSettings, ground: bool) -> RigidScene:
    assembly, control_sets = edit.assembly, edit.control_sets
    poses = split_controls(edit.controls, control_sets)
    movers = [_mover(assembly, each) for each in control_sets]
    surface, positions = assembly.surface, assembly.positions
    if ground:
        first = len(positions)
        surface, positions = _with_ground(surface, positions)
        rows = np.arange(first, first + 4, dtype=np.int32)
        movers.append(Mover(GROUND, rows, stiv.rigid(positions[rows]), can_turn=False))
        poses.append(stiv.rigid_rest_controls(positions[rows]))
    separations = {(int(a), int(b)): h for (a, b), h in body_separations(assembly, settings).items()}
    moving = [number for number, each in enumerate(movers) if each.name != GROUND]
    return RigidScene(surface, positions, movers, poses, settings.separation, separations, settings.threads, moving)


def _mover(assembly: Assembly, control_set: ControlSet) -> Mover:
    weights = control_set.max_weights
    can_turn = weights.ndim == 1 and bool(weights[1] > 0)
    free = None
    if weights.ndim == 2 and control_set.weight_axes is not None:
        axes = control_set.weight_axes[0]
        free = (axes * weights[0]) @ axes.T
    rows = assembly.vertices_of(control_set.surfaces)
    return Mover(control_set.names[0], rows, control_set.deformation, can_turn, free)


def _with_ground(surface: stiv.Surface, positions: Floats) -> tuple[stiv.Surface, Floats]:
    """The surface with a large square in the plane z = 0 as a last body."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    reach = GROUND_SIZE * float(np.linalg.norm(high - low))
    center = np.array([*(low + high)[:2] / 2, 0.0])
    corners = center + reach * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float64)
    first, bodies = len(positions), surface.bodies
    larger = stiv.Surface(
        np.concatenate([surface.triangles, np.array([[0, 1, 2], [0, 2, 3]], np.int32) + np.int32(first)]),
        first + 4,
        surface.loose_edges,
        np.append(surface.vertex_body, np.full(4, len(bodies), np.int32)),
        [*bodies, stiv.Body(GROUND, "fixed")],
        surface.ignored.tolist(),
    )
    return larger, np.concatenate([positions, corners])
