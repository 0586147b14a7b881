# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the control set of selected pose bones: their free channels move all meshes that follow the rigs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.auto_keying import insert_auto_keyframes
from stiv.blender.controls.bone_channels import LOCATION, ROTATION, SCALE, BoneChannels, MirroredBone
from stiv.blender.controls.control_set import ControlSet, GoalRule, Participant, UnlimitedGoal, Writer
from stiv.blender.controls.garments import Garment, stacked_weights
from stiv.blender.controls.joined_seams import join_notes
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.posed_surface import BoneScalars, PosedSurface
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.driver_cycles import find_driver_cycle
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import SURFACE_TYPES, is_visible
from stiv.blender.scene.followers import find_followers
from stiv.blender.scene.pose_bones import is_hidden, is_selected, moved_bones, selected_bones
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings

CHANNELS = {"move": (LOCATION,), "rotate": (ROTATION,), "scale": (SCALE,)}  # that respond
MOVED = {"move": (LOCATION,), "rotate": (LOCATION, ROTATION), "scale": (LOCATION, SCALE)}  # by the goal


def poses_surface(context: bpy.types.Context) -> bool:
    """Do the armatures in Pose Mode move a visible surface?"""
    names = find_followers(context.scene, {rig.name for rig in context.objects_in_mode})
    return any(
        ob.type in SURFACE_TYPES and ob.name in names and is_visible(context, ob) for ob in context.scene.objects
    )


def has_movable_bones(context: bpy.types.Context) -> bool:
    """Is a selected bone free to move, rather than connected to its parent?"""
    bones = [bone for rig in context.objects_in_mode for bone in moved_bones(rig)]
    return any(bone.parent is None or not bone.bone.use_connect for bone in bones)


def find_posed_rigs(context: bpy.types.Context) -> list[Participant]:
    """The armatures in Pose Mode with selected bones. Raises InputError by name."""
    rigs = [ob for ob in context.objects_in_mode if selected_bones(ob)]
    for rig in rigs:
        check_rig(rig)
    if not rigs:
        raise InputError("no bone is selected; select one")
    return [Participant(ObjectReference.of(rig), "bones", True) for rig in rigs]


def make_bone_set(
    context: bpy.types.Context,
    participants: Sequence[Participant],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
    kind: str,
    garments: Sequence[Garment] = (),
) -> ControlSet:
    """Make the control set of the selected bones of all rigs, and of the garments that yield to them.

    Raises InputError by name.
    """
    rigs = [each.reference.find() for each in participants]
    individual = context.scene.tool_settings.transform_pivot_point == "INDIVIDUAL_ORIGINS"
    bones: list[BoneChannels] = []
    responses: list[Floats] = []
    for rig, participant in zip(rigs, participants, strict=True):
        found = list(participant.bones) or _moved_bones(rig, kind, individual)
        if settings.responders != "selected" and not participant.bones and not garments:
            moved = {name for each in found for name in (each.name, each.mirrored and each.mirrored.name) if name}
            found += _other_bones(rig, moved)
        bones += found
        given = 0.0 if garments and settings.responders == "unselected" else 1.0
        responses += [np.full(10, given) if participant.bones else _weights(bone, kind, settings) for bone in found]
    followers = find_followers(context.scene, {rig.name for rig in rigs})
    if not any(mesh.owner.name in followers for mesh in meshes):
        raise InputError(f"{rigs[0].name}: it deforms no visible mesh; parent one to it")
    torn = participants[0].torn
    posed = PosedSurface(bones, frozenset(followers), meshes, responses, settings.joint_region, garments, torn)
    scalars = BoneScalars(tuple(bones))
    weights = scalars.of(responses)
    names, start, writer = tuple(rig.name for rig in rigs), as_controls(posed.start), BoneWriter(scalars, MOVED[kind])
    bare = ControlSet(
        names, "bones", posed.surfaces, posed.deformation, start, weights, weights, None, BoneGoal(scalars), writer,
        seams=posed.seams, note=posed.note, posed=posed,
    )  # fmt: skip
    return dressed(bare, [each.controls for each in garments]) if garments else bare


def dressed(bones: ControlSet, garments: Sequence[ControlSet]) -> ControlSet:
    """The control set of bones followed by those of garments, which have one deformation together."""
    sets = [bones, *garments]
    axes = [np.eye(3)[None].repeat(len(s.controls), 0) if s.weight_axes is None else s.weight_axes for s in sets]
    return replace(
        bones,
        names=tuple(name for each in sets for name in each.names),
        controls=np.concatenate([each.controls for each in sets]),
        weights=stacked_weights([each.weights for each in sets]),
        max_weights=stacked_weights([each.max_weights for each in sets]),
        weight_axes=np.concatenate(axes) if any(each.weight_axes is not None for each in garments) else None,
        rule=DressedGoal(bones.rule, len(bones.controls)),
        writer=DressedWriter(tuple((each.writer, len(each.controls)) for each in sets)),
        note=join_notes(*(each.note for each in sets)),
    )


def check_rig(rig: bpy.types.Object) -> None:
    """Refuse a rig whose pose cannot be changed, or depends on itself. Raises InputError by name."""
    if not rig.is_editable or (rig.override_library is not None and rig.override_library.is_system_override):
        raise InputError(f"{rig.name}: it is linked; make a library override of it")
    if rig.data.pose_position == "REST":
        raise InputError(f"{rig.name}: it shows its rest position; choose Pose Position")
    owner, driven = find_driver_cycle(rig)
    if driven:
        raise InputError(f"{owner}: a driver of {driven} depends on itself; remove it")


def _moved_bones(rig: bpy.types.Object, kind: str, individual: bool) -> list[BoneChannels]:
    """The bones that the goal moves, as Blender chooses them. Raises InputError if all their channels are locked."""
    selected = moved_bones(rig, individual and kind == "rotate")
    bones = [BoneChannels.read(rig, bone, True).limited_to(*MOVED[kind]) for bone in selected]
    able = [bone for bone in bones if len(bone.limited_to(*CHANNELS[kind]).free)]
    if bones and not able:
        raise InputError(_locked_message(rig, rig.pose.bones[bones[0].name], kind))
    return [_with_mirrored(rig, each) for each in able] if rig.pose.use_mirror_x else able


def _with_mirrored(rig: bpy.types.Object, channels: BoneChannels) -> BoneChannels:
    """The bone with the one on the other side, unless that is selected too."""
    bone, other = rig.pose.bones[channels.name], rig.pose.bones.get(bpy.utils.flip_name(channels.name))
    if other is None or other == bone or is_selected(other):
        return channels
    return replace(channels, mirrored=MirroredBone.read(bone, other))


def _locked_message(rig: bpy.types.Object, bone: bpy.types.PoseBone, kind: str) -> str:
    if kind == "move" and bone.parent is not None and bone.bone.use_connect:
        return f"{rig.name}: {bone.name} is connected to its parent; rotate it"
    if kind == "move":
        return f"{rig.name}: the location of {bone.name} is locked; unlock it"
    if kind == "rotate":
        return f"{rig.name}: the rotation of {bone.name} is locked; unlock it"
    return f"{rig.name}: the scale of {bone.name} is locked; unlock it"


def _other_bones(rig: bpy.types.Object, moved: set[str]) -> list[BoneChannels]:
    """The other visible bones that can rotate."""
    others = [bone for bone in rig.pose.bones if bone.name not in moved and not is_hidden(bone)]
    found = [BoneChannels.read(rig, bone, False).limited_to(ROTATION) for bone in others]
    return [bone for bone in found if len(bone.free)]


def _weights(bone: BoneChannels, kind: str, settings: EditSettings) -> Floats:
    """Response weights of the channels, (10,): channels of another kind follow the goal exactly."""
    weights = np.zeros(10)
    for channels in CHANNELS[kind] if bone.selected else (ROTATION,):
        weights[channels] = settings.response_weight(bone.selected)
    return weights


@dataclass(frozen=True)
class BoneGoal(UnlimitedGoal):
    """How the free channels of bones follow a motion of the selection."""

    scalars: BoneScalars

    @property
    def moves(self) -> bool:
        """Is a bone selected?"""
        return any(bone.selected for bone in self.scalars.bones)

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the controls, (k, 3)."""
        found = [
            bone.goal(before, motion) if bone.selected else bone.start
            for bone, before in self.scalars.channels(last[:, 0])
        ]
        return as_controls(self.scalars.of(found))


@dataclass(frozen=True)
class BoneWriter:
    """Writes the free channels of bones. `keyed`: those of the bones that the goal moves, by range."""

    scalars: BoneScalars
    keyed: tuple[slice, ...]

    def write(self, controls: Floats) -> None:
        """Write controls, (k, 3). Raises SceneChangedError if a bone is gone."""
        for bone, channels in self.scalars.channels(controls[:, 0]):
            bone.write(channels, bone.find())

    def restore(self) -> None:
        """Restore the start to the last bit."""
        self.write(as_controls(self.scalars.start))

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for the bones that the goal moves, and for others that have changed."""
        found: list[tuple[bpy.types.PoseBone, set[str]]] = []
        for each in self.scalars.bones:
            bone = each.find()
            always = {each.property_of(self.keyed[-1], bone)} if each.selected else set()
            found.append((bone, always.union(each.stored.changed(bone))))
            if each.mirrored is not None:
                other = bone.id_data.pose.bones[each.mirrored.name]
                found.append((other, always.union(each.mirrored.stored.changed(other))))
        insert_auto_keyframes(context, found)


@dataclass(frozen=True)
class DressedGoal(UnlimitedGoal):
    """The goal of bones, (k, 3), and garments, which rest."""

    bones: GoalRule
    count: int

    @property
    def moves(self) -> bool:
        """Is a bone selected?"""
        return self.bones.moves

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the controls, (m, 3)."""
        bones = self.bones.goal(controls[: self.count], last[: self.count], motion)
        return np.concatenate([bones, controls[self.count :]])


@dataclass(frozen=True)
class DressedWriter:
    """Writes bones, then garments: writers with their number of controls."""

    writers: tuple[tuple[Writer, int], ...]

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3). Raises SceneChangedError."""
        first = 0
        for writer, count in self.writers:
            writer.write(controls[first : first + count])
            first += count

    def restore(self) -> None:
        """Restore the start to the last bit."""
        for writer, _ in self.writers:
            writer.restore()

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for the bones."""
        for writer, _ in self.writers:
            if isinstance(writer, BoneWriter):
                writer.insert_keyframes(context)


def as_controls(scalars: Floats) -> Floats:
    """Controls, (k, 3), of scalars, (k,)."""
    controls = np.zeros((len(scalars), 3))
    controls[:, 0] = scalars
    return controls
