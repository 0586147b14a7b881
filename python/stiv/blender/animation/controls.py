# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts tracks to controls: a placement for rigid objects, all vertices for deforming ones."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import bpy
import mathutils
import numpy as np

import stiv
from stiv.blender.animation.tracks import Track, lasting_seams
from stiv.blender.controls.object_transform import check_axes
from stiv.blender.controls.rotations import (
    affine_about,
    nearest_equivalent,
    nearest_rotation,
    rotation_matrix,
    rotation_vector,
)
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.dependencies import ancestors
from stiv.seams import Seams

RIGHT_ANGLE = 1e-4  # cosine of an angle that still is one: frames of rigs are less accurate than objects at rest


@dataclass(frozen=True)
class MovingSet:
    """Objects that share a placement (`frame` None), or an object whose vertices are the controls.

    `tracks` are the indices of its meshes. `frame`, (4, 4), is the frame in which vertices are stored.
    """

    tracks: tuple[int, ...]
    deformation: stiv.Deformation
    controls: Floats  #: (m, 3) at the first frame
    weight: float
    frame: Floats | None
    control_seams: Seams | None = None  #: vertices of a deforming mesh that coincide at all frames, and continue to

    def goal(self, tracks: Sequence[Track], frame: int, last: Floats) -> Floats:
        """Goal of the controls at a frame, (m, 3); `last` is the goal of the frame before."""
        track = tracks[self.tracks[0]]
        if self.frame is not None:
            return track.world(frame) if self.control_seams is None else track.world(frame)[self.control_seams.first]
        motion = track.motion(frame)
        turn = nearest_equivalent(rotation_vector(nearest_rotation(motion[:3, :3])), last[1])
        return np.array([transform_points(motion, self.controls[:1])[0], turn])

    def motion(self, controls: Floats) -> Floats:
        """World matrix, (4, 4), from the first frame to the placement of the controls."""
        return affine_about(self.controls[0], rotation_matrix(controls[1]), controls[0])


def make_moving_sets(tracks: Sequence[Track], hold: Collection[str]) -> list[MovingSet]:
    """Make the controls of all moving objects; connected objects that move alike share them. Raises InputError."""
    parts = [_rigid(tracks, group, hold) for group in _rigid_groups(tracks)]
    shapes = [index for index, track in enumerate(tracks) if track.kind == "shape"]
    return parts + [_shape(tracks, index, hold) for index in shapes]


def stored_placement(ob: bpy.types.Object, matrix: Floats) -> tuple[mathutils.Vector, ...]:
    """Location, rotation (a quaternion) and scale of a world matrix. Raises InputError if the matrix is sheared."""
    check_axes(ob.name, matrix, RIGHT_ANGLE)
    parts: tuple[mathutils.Vector, ...] = mathutils.Matrix(matrix.tolist()).decompose()
    return parts


def _weight(tracks: Sequence[Track], group: Sequence[int], hold: Collection[str]) -> float:
    return 0.0 if any(tracks[index].mesh.owner.name in hold for index in group) else 1.0


def _rigid(tracks: Sequence[Track], group: tuple[int, ...], hold: Collection[str]) -> MovingSet:
    rest = np.concatenate([tracks[index].world(0) for index in group])
    controls = stiv.rigid_rest_controls(rest)
    return MovingSet(group, stiv.rigid(rest), controls, _weight(tracks, group, hold), None)


def _shape(tracks: Sequence[Track], index: int, hold: Collection[str]) -> MovingSet:
    """Vertices are stored in the frame that Blender makes of the object's first placement."""
    track = tracks[index]
    frame = as_matrix(mathutils.Matrix.LocRotScale(*stored_placement(track.mesh.owner.find(), track.matrices[0])))
    control_seams = lasting_seams(track)
    world = track.world(0) if control_seams is None else track.world(0)[control_seams.first]
    return MovingSet((index,), stiv.identity(len(world)), world, _weight(tracks, (index,), hold), frame, control_seams)


def _rigid_groups(tracks: Sequence[Track]) -> list[tuple[int, ...]]:
    groups: list[list[int]] = []
    for index, track in enumerate(tracks):
        if track.kind != "rigid":
            continue
        same = next((group for group in groups if move_alike(tracks[group[0]], track)), None)
        if same is None:
            groups.append([index])
        else:
            same.append(index)
    return [tuple(group) for group in groups]


def move_alike(one: Track, other: Track) -> bool:
    """Do two tracks share a root object and keep their relative placement?"""
    if _root(one) != _root(other):
        return False
    size = max(float(np.abs(track.matrices[0]).max()) for track in (one, other))
    frames = range(len(one.matrices))
    return all(np.abs(one.motion(frame) - other.motion(frame)).max() <= 1e-5 * size for frame in frames)


def _root(track: Track) -> str:
    ob = track.mesh.owner.find()
    return [str(ob.name), *ancestors(ob)][-1]
