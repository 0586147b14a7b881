# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the motion of every visible mesh over all frames."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.rotations import is_rotation
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.references import type_name
from stiv.blender.verify.frame_check import set_frame
from stiv.seams import Seams, common_seams


@dataclass(frozen=True)
class Track:
    """One mesh over all frames: `kind` is "still", "rigid" or "shape" (deforming). Equal frames share their arrays."""

    mesh: VisibleMesh  #: at the first frame
    locals: tuple[Singles, ...]  #: (n, 3) at each frame, in the mesh's own frame
    matrices: tuple[Floats, ...]  #: (4, 4) at each frame
    kind: str = field(default="still")

    def world(self, frame: int) -> Floats:
        """World positions, (n, 3), at a frame, by index."""
        return transform_points(self.matrices[frame], self.locals[frame])

    def motion(self, frame: int) -> Floats:
        """World matrix, (4, 4), from the first frame to this one, for rigid meshes."""
        moved: Floats = self.matrices[frame] @ np.linalg.inv(self.matrices[0])
        return moved


def lasting_seams(track: Track) -> Seams | None:
    """Seams of a mesh that are closed at every frame."""
    seams = mesh_seams(track.locals[0], track.mesh.triangles)
    for before, local in pairwise(track.locals):
        if seams is not None and local is not before:
            seams = common_seams(seams, mesh_seams(local, track.mesh.triangles))
    return seams


def read_tracks(
    context: bpy.types.Context, frames: Sequence[float], evaluations: Collection[str] = (SHOWN,)
) -> list[Track]:
    """Read all meshes of these evaluations at these frames; a mesh that several evaluations share is read once.

    Raises InputError for meshes that appear, disappear, or change their number of vertices.
    """
    locals_: list[list[Singles]] = []
    matrices: list[list[Floats]] = []
    first: tuple[VisibleMesh, ...] = ()
    for frame in frames:
        set_frame(context.scene, frame)
        meshes = read_scene(context, evaluations=evaluations).meshes
        if not first:
            first = meshes
            locals_, matrices = [[mesh.local] for mesh in meshes], [[mesh.matrix] for mesh in meshes]
            continue
        _check_same(first, meshes, frames[0], frame)
        for mesh, shapes, places in zip(_in_order_of(first, meshes), locals_, matrices, strict=True):
            shapes.append(shapes[-1] if np.array_equal(shapes[-1], mesh.local) else mesh.local)
            places.append(mesh.matrix)
    tracks = [Track(m, tuple(a), tuple(b)) for m, a, b in zip(first, locals_, matrices, strict=True)]
    return [Track(track.mesh, track.locals, track.matrices, _kind(track)) for track in tracks]


def check_movable(tracks: Sequence[Track], hold: Collection[str]) -> None:
    """Refuse moving objects that cannot be written, and names in `hold` that do not move. Raises InputError."""
    moving = {track.mesh.owner.name for track in tracks if track.kind != "still"}
    unknown = sorted(set(hold) - moving)
    if unknown:
        raise InputError(f"{unknown[0]}: does not move in these frames; remove it from --hold")
    for track in tracks:
        if track.kind == "still":
            continue
        ob = track.mesh.owner.find()
        if track.mesh.is_instance:
            raise InputError(f"{ob.name}: shows instances that move; make them real")
        if ob.library is not None or (ob.data is not None and ob.data.library is not None):
            raise InputError(f"{ob.name}: is linked from another file and moves; make it local")
        if track.kind == "shape" and ob.type != "MESH":
            raise InputError(f"{ob.name}: a {type_name(ob)} that deforms; convert it to a mesh")


_Identity = tuple[int, str, frozenset[str]]  # identifies a mesh over all frames; instances may share it


def _identity(mesh: VisibleMesh) -> _Identity:
    return mesh.owner.session_uid, mesh.source, mesh.shown_in


def _in_order_of(first: Sequence[VisibleMesh], meshes: Sequence[VisibleMesh]) -> list[VisibleMesh]:
    """The meshes in the order of the first frame."""
    waiting: dict[_Identity, list[VisibleMesh]] = defaultdict(list)
    for mesh in reversed(meshes):
        waiting[_identity(mesh)].append(mesh)
    return [waiting[_identity(mesh)].pop() for mesh in first]


def _check_same(first: Sequence[VisibleMesh], meshes: Sequence[VisibleMesh], start: float, frame: float) -> None:
    now = {_identity(mesh): mesh for mesh in meshes}
    names = {_identity(mesh) for mesh in first}
    for mesh in first:
        other = now.get(_identity(mesh))
        if other is None:
            raise InputError(_missing(mesh, meshes, start, frame))
        if len(other.local) != len(mesh.local) or len(other.triangles) != len(mesh.triangles):
            raise InputError(
                f"{mesh.owner.name}: other vertices at frame {frame:g}; apply the modifier that changes them"
            )
    for key, mesh in now.items():
        if key not in names:
            raise InputError(_missing(mesh, first, frame, start))
    if Counter(map(_identity, first)) != Counter(map(_identity, meshes)):
        raise InputError(f"the number of instances changes at frame {frame:g}; make them real")


def _missing(mesh: VisibleMesh, others: Sequence[VisibleMesh], here: float, there: float) -> str:
    """Message about a mesh that exists at only one of two frames."""
    name = mesh.owner.name
    if any(_identity(mesh)[:2] == _identity(other)[:2] for other in others):
        return f"{name}: is rendered differently at frame {there:g}; keep its render settings, or use --guard viewport"
    return f"{name}: is visible at frame {here:g}, but not at frame {there:g}"


def _kind(track: Track) -> str:
    if any(shape is not track.locals[0] for shape in track.locals):
        return "shape"
    if all(np.array_equal(matrix, track.matrices[0]) for matrix in track.matrices):
        return "still"
    rigid = all(is_rotation(track.motion(frame)[:3, :3]) for frame in range(len(track.matrices)))
    return "rigid" if rigid else "shape"
