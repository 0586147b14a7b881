# SPDX-License-Identifier: GPL-3.0-or-later
"""From tracks to controls: a placement for what moves rigidly, all vertices of what changes its shape."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

import bpy
import mathutils
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.animation.tracks import Track
from stiv.blender.controls.rotations import about, nearest_rotation, nearest_turn, rotation_matrix, rotation_vector
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.assembly import mesh_seams
from stiv.seams import Seams, common_seams

SHEAR = 1e-4  # by which a placement may differ from location, rotation and scale, relative to its size


@dataclass(frozen=True)
class MovingPart:
    """Objects that follow one placement (`frame` None), or one whose vertices are the controls.

    `tracks` are the places of its meshes among all tracks. `frame` (4, 4) is where the vertices are stored.
    """

    tracks: tuple[int, ...]
    deformation: stiv.Deformation
    controls: Floats  #: (m, 3) at the first frame
    weight: float
    frame: Floats | None
    tied: Seams | None = None  #: vertices of a shape that are in one place at all frames, and stay so

    def goal(self, tracks: Sequence[Track], frame: int, last: Floats) -> Floats:
        """What the animation asks of the controls at a frame, (m, 3); `last` is what it asked before."""
        track = tracks[self.tracks[0]]
        if self.frame is not None:
            return track.world(frame) if self.tied is None else track.world(frame)[self.tied.first]
        motion = track.motion(frame)
        turn = nearest_turn(rotation_vector(nearest_rotation(motion[:3, :3])), last[1])
        return np.array([transform_points(motion, self.controls[:1])[0], turn])

    def motion(self, controls: Floats) -> Floats:
        """From the world at the first frame to where a placement's controls put it, (4, 4)."""
        return about(self.controls[0], rotation_matrix(controls[1]), controls[0])


def make_moving_parts(tracks: Sequence[Track], hold: Collection[str]) -> list[MovingPart]:
    """Parts for all that moves; what hangs together and moves alike is one. Raises InputError."""
    parts = [_rigid(tracks, group, hold) for group in _rigid_groups(tracks)]
    shapes = [index for index, track in enumerate(tracks) if track.kind == "shape"]
    return parts + [_shape(tracks, index, hold) for index in shapes]


def stored_placement(ob: bpy.types.Object, matrix: Floats) -> tuple[mathutils.Vector, ...]:
    """Location, rotation (a quaternion) and scale of a world matrix. Raises InputError where they do not give it."""
    parts: tuple[mathutils.Vector, ...] = mathutils.Matrix(matrix.tolist()).decompose()
    rebuilt = as_matrix(mathutils.Matrix.LocRotScale(*parts))
    if np.abs(rebuilt - matrix).max() > SHEAR * np.abs(matrix).max():
        raise InputError(f'object "{ob.name}": is sheared by its parent; apply its transform, or clear the parent')
    return parts


def _weight(tracks: Sequence[Track], group: Sequence[int], hold: Collection[str]) -> float:
    return 0.0 if any(tracks[index].mesh.owner.name in hold for index in group) else 1.0


def _rigid(tracks: Sequence[Track], group: tuple[int, ...], hold: Collection[str]) -> MovingPart:
    rest = np.concatenate([tracks[index].world(0) for index in group])
    controls = stiv.rigid_rest_controls(rest)
    return MovingPart(group, stiv.rigid(rest), controls, _weight(tracks, group, hold), None)


def _shape(tracks: Sequence[Track], index: int, hold: Collection[str]) -> MovingPart:
    """Vertices are stored in the frame that Blender makes of the object's first placement."""
    track = tracks[index]
    frame = as_matrix(mathutils.Matrix.LocRotScale(*stored_placement(track.mesh.owner.find(), track.matrices[0])))
    tied = _seams(track)
    world = track.world(0) if tied is None else track.world(0)[tied.first]
    return MovingPart((index,), stiv.identity(len(world)), world, _weight(tracks, (index,), hold), frame, tied)


def _seams(track: Track) -> Seams | None:
    """The seams of a mesh that are closed at every frame."""
    seams = mesh_seams(track.locals[0], track.mesh.triangles)
    for before, local in pairwise(track.locals):
        if seams is not None and local is not before:
            seams = common_seams(seams, mesh_seams(local, track.mesh.triangles))
    return seams


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
    """Have they a common ancestor (or is one the other's), and do they keep their places to each other?"""
    if _root(one) != _root(other):
        return False
    size = max(float(np.abs(track.matrices[0]).max()) for track in (one, other))
    frames = range(len(one.matrices))
    return all(np.abs(one.motion(frame) - other.motion(frame)).max() <= 1e-5 * size for frame in frames)


def _root(track: Track) -> str:
    ob = track.mesh.owner.find()
    while ob.parent is not None:
        ob = ob.parent
    return str(ob.name)
