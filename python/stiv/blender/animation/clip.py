# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of an animated scene as a function of time and of corrections of its animated parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.animation.animated_parts import AnimatedPart, Values
from stiv.blender.animation.tracks import Track, lasting_seams
from stiv.blender.controls.closed_seams import MergedRows, limit_to_closed, seams_of_part
from stiv.blender.controls.joint_regions import Joint, Regions, divide_all, joint_note, part_of, untested_parts
from stiv.blender.controls.rig_twin import skin_weights
from stiv.blender.scene.arrays import Floats, Indices, as_matrix
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_positions_of
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.scene.passing import passing_pairs
from stiv.blender.verify.frame_check import set_frame
from stiv.seams import Seams

SAMPLES = 12  # frames at which turning bones are looked for
TURNED = 1e-4  # change of a matrix above which a bone turns against its parent
STEP = 0.01  # of the differences for a Jacobian: radians, and diagonals of the surface
LONGEST_MOVE = 0.1  # diagonals of the surface that a location may change, without another limit
TIME_STEP = 0.25  # the same for the time, frames


class Clip:
    """A scene with an animation, evaluated by Blender. Values are the corrections of all parts, then the frame.

    Only the file in memory changes; `restore` undoes that.

    Attributes:
        parts: whose correction moves a visible mesh.
        meshes: all visible meshes; those that bones bend are divided at joints.
        divided: pairs of names of objects, or one name, of which some parts are not tested.
        regions: the parts of each mesh.
        moving_meshes: the objects whose meshes move, with the vertices of these, see `rows`.
        note: on the faces at joints; "" without any.
        leaders: for each vertex of all meshes before they were divided, the one with which it coincides, (n,).
    """

    def __init__(
        self,
        context: bpy.types.Context,
        parts: Sequence[AnimatedPart],
        tracks: Sequence[Track],
        frames: Sequence[float],
        joint_region: float,
        regions: Sequence[Regions] = (),
    ) -> None:
        """tracks: of all visible meshes over all frames; the first one is shown. regions: those of another
        clip of the same scene. Raises InputError if the parts move no mesh."""
        self._context, self._opened = context, OpenEvaluations(context)
        self._start = [(part, part.read()) for part in parts]
        self._frame = float("nan")
        self._bases: list[Values] = []
        self.parts = tuple(parts)
        self._owners = frozenset(track.mesh.owner.session_uid for track in tracks)
        if not tracks:
            raise _no_mesh(parts)
        self._rows = np.cumsum([0, *(len(track.mesh.local) for track in tracks)])
        self._size = float(np.linalg.norm(np.ptp(np.concatenate([track.world(0) for track in tracks]), axis=0))) or 1.0
        self._take_effective_parts(frames[0])
        seams = [self._closed_seams(track) for track in tracks]
        self._assemble(tracks, regions or self._regions(tracks, frames, joint_region, seams), seams)

    @property
    def count(self) -> int:
        """Number of values of a correction."""
        return sum(part.count for part in self.parts)

    @property
    def assembly(self) -> Assembly:
        """One surface of all meshes."""
        stiff = [mesh for mesh, kind in zip(self.meshes, self._kinds, strict=True) if kind == "rigid"]
        rigid = {(part_of(mesh, 0), part_of(mesh, 0)) for mesh in stiff}
        mobility = ["fixed" if kind == "still" else "deformable" for kind in self._kinds]
        passing = passing_pairs(self._context.scene)
        return assemble(self.meshes, mobility, (), passing, self._seams, self._untested | rigid)

    @property
    def moving(self) -> tuple[int, ...]:
        """Indices of the meshes that move."""
        return tuple(k for k, kind in enumerate(self._kinds) if kind != "still")

    def limits(self) -> tuple[Floats, Floats]:
        """Lower and upper limits of the values, (k + 1,)."""
        upper = [value for part in self.parts for value in part.most]
        most = np.array([LONGEST_MOVE * self._size if np.isinf(value) else value for value in upper])
        return np.append(-most, -np.inf), np.append(most, np.inf)

    def split(self, correction: Floats) -> list[Floats]:
        """The correction of each part."""
        return np.split(correction, np.cumsum([part.count for part in self.parts])[:-1])

    def pose(self, frame: float, correction: Floats) -> list[Values]:
        """Show a frame with a correction, (k,); the values of each part."""
        if frame != self._frame:
            for part, values in self._start:
                part.write(values)  # of the channels without keys
            set_frame(self._context.scene, frame)
            self._bases = [part.read() for part in self.parts]
            self._frame = frame
        rows = zip(self.parts, self._bases, self.split(correction), strict=True)
        found = [part.corrected(base, own) for part, base, own in rows]
        for part, values in zip(self.parts, found, strict=True):
            part.write(values)
        self._context.view_layer.update()
        return found

    def surface(self, values: Floats) -> Floats | None:
        """World positions of the moving meshes, (n, 3), at values, (k + 1,).

        None if their topology changes, or a seam opens.
        """
        whole = self._read(values)
        return None if whole is None else self._moving.merged(whole)

    @property
    def rows(self) -> Indices:
        """For each vertex of the assembly, its number in the meshes before they were divided, (N,)."""
        return self._all.rows

    @property
    def size(self) -> float:
        """Length of the diagonal of all meshes."""
        return self._size

    def whole_mesh(self, frame: float, correction: Floats) -> Floats:
        """World positions of all meshes before they were divided. Raises InputError if their topology changes."""
        whole = self._read(np.append(correction, frame))
        if whole is None:
            raise InputError(f"a mesh changes its vertices at frame {frame:g}; apply the modifier that does this")
        return whole

    def whole_surface(self, frame: float, correction: Floats) -> Floats:
        """World positions of all meshes in the assembly, (N, 3). Raises InputError if their topology changes."""
        found: Floats = self.whole_mesh(frame, correction)[self.rows]
        return found

    def jacobian(self, values: Floats, towards: float) -> Floats:
        """One-sided differences, (n, 3, k + 1), at values; those by the frame in the direction of time `towards`."""
        steps = np.array([*self._steps(), TIME_STEP * (1 if towards >= 0 else -1)])
        here = self.surface(values)
        result = np.zeros((len(self._moving.rows), 3, len(values)))
        for k, step in enumerate(steps):
            moved = values.copy()
            moved[k] += step
            there = self.surface(moved)
            if here is not None and there is not None:
                result[:, :, k] = (there - here) / step
        return result

    def restore(self, frame: float) -> None:
        """Show a frame of the animation without corrections."""
        self.pose(frame, np.zeros(self.count))
        for part, values in self._start:
            part.write(values)
        set_frame(self._context.scene, frame)
        self._frame = float("nan")

    def _steps(self) -> list[float]:
        return [
            step
            for part in self.parts
            for step in (*(STEP * self._size for _ in part.location), *(STEP for _ in part.rotation))
        ]

    def _read(self, values: Floats) -> Floats | None:
        self.pose(float(values[-1]), values[:-1])
        found = read_positions_of(self._owners, self._opened)
        sizes = np.diff(self._rows).tolist()
        if [len(each.local) for each in found] != sizes:
            return None
        whole = np.concatenate([each.world() for each in found])
        return whole if np.isfinite(whole).all() else None

    def _take_effective_parts(self, frame: float) -> None:
        """Leave out the parts without an effect on the surface, such as bones of an inverse kinematics."""
        here = self._read(np.append(np.zeros(self.count), frame))
        columns, moved = [], []
        for correction in np.diag(self._steps()):
            there = self._read(np.append(correction, frame))
            columns.append(here is None or there is None or bool(np.abs(there - here).max() > 1e-6 * self._size))
        for part, own in zip(self.parts, self.split(np.array(columns)), strict=True):
            if own.any():
                moved.append(part)
        self.pose(frame, np.zeros(self.count))
        if not moved:
            raise _no_mesh(self.parts)
        self.parts, self._frame = tuple(moved), float("nan")

    def _closed_seams(self, track: Track) -> Seams | None:
        """The seams of a mesh that are closed at every frame, and have equal weights of bones."""
        seams = lasting_seams(track) if track.kind == "shape" else None
        weights = None if seams is None else self._weights(track.mesh)[1]
        return limit_to_closed(seams, track.mesh, (), weights)

    def _regions(
        self,
        tracks: Sequence[Track],
        frames: Sequence[float],
        joint_region: float,
        seams: Sequence[Seams | None],
    ) -> list[Regions]:
        """The regions around joints of each mesh; one part if no bones bend it."""
        found = [Regions((track.mesh,), frozenset(), 0, 0) for track in tracks]
        bending = [k for k, track in enumerate(tracks) if track.kind == "shape" and joint_region > 0]
        if bending:
            here = np.append(np.zeros(self.count), frames[0])
            joints = self._joints(frames)
            rows = np.concatenate([np.arange(*self._rows[k : k + 2]) for k in bending])
            self._moving = MergedRows.of([np.arange(self._rows[-1], dtype=np.int32)], [None], np.empty((0, 3)))
            jacobian = self.jacobian(here, 1)[rows]
            self.pose(frames[0], np.zeros(self.count))
            meshes = [tracks[k].mesh for k in bending]
            weights, own = [self._weights(mesh) for mesh in meshes], [seams[k] for k in bending]
            divided = divide_all(meshes, weights, joints, jacobian, joint_region, own)
            for k, each in zip(bending, divided, strict=True):
                found[k] = each
        return found

    def _assemble(self, tracks: Sequence[Track], regions: Sequence[Regions], seams: Sequence[Seams | None]) -> None:
        """Take the meshes with these parts, and these seams of the whole meshes."""
        parts = [_parts_of(track.mesh, each) for track, each in zip(tracks, regions, strict=True)]
        self.regions = tuple(regions)
        self.note = joint_note([track.mesh for track in tracks], regions)
        self._untested = untested_parts([track.mesh for track in tracks], regions)
        self.divided = frozenset(frozenset((first, second)) for (first, *_), (second, *_) in self._untested)
        self.meshes = tuple(part for own in parts for part in own)
        self._kinds = [track.kind for track, own in zip(tracks, parts, strict=True) for _ in own]
        self._seams = [seams_of_part(each, part) for each, own in zip(seams, parts, strict=True) for part in own]
        firsts = self._rows.tolist()
        rows = [first + _vertices(part) for first, own in zip(firsts, parts, strict=False) for part in own]
        start = np.concatenate([track.world(0) for track in tracks])
        self._all = MergedRows.of(rows, self._seams, start)
        self._moving = MergedRows.of([rows[k] for k in self.moving], [self._seams[k] for k in self.moving], start)
        self.leaders = np.concatenate([
            first + (np.arange(len(track.mesh.local)) if own is None else own.leaders)
            for first, track, own in zip(firsts, tracks, seams, strict=False)
        ])  # fmt: skip
        self.moving_meshes = {
            track.mesh.owner: np.arange(*self._rows[k : k + 2], dtype=np.int32)
            for k, track in enumerate(tracks)
            if track.kind != "still" and not track.mesh.is_instance
        }

    def _weights(self, mesh: VisibleMesh) -> tuple[list[str], Floats]:
        bones = {bone.name for part in self.parts if (ob := part.owner.find()).pose for bone in ob.pose.bones}
        return skin_weights(self._opened.evaluated(mesh.read_from, mesh.owner), bones, len(mesh.local))

    def _joints(self, frames: Sequence[float]) -> list[Joint]:
        """The bones that turn against their parents, at their places in the present pose."""
        rigs = list({part.owner: part.owner.find() for part in self.parts if part.bone}.values())
        present, turned = _local_matrices(rigs), set()
        for frame in frames[:: max(1, len(frames) // SAMPLES)]:
            self.pose(frame, np.zeros(self.count))
            found = _local_matrices(rigs)
            turned |= {bone for bone, matrix in found.items() if np.abs(matrix - present[bone]).max() > TURNED}
        turned |= {(part.owner.name, part.bone) for part in self.parts}
        self.pose(frames[0], np.zeros(self.count))
        joints = []
        for rig in rigs:
            for bone in (
                each for each in rig.pose.bones if each.parent is not None and (rig.name, each.name) in turned
            ):
                names = frozenset({bone.name, *(each.name for each in bone.children_recursive)})
                joints.append(Joint(np.array(rig.matrix_world @ bone.head), names))
        return joints


def _no_mesh(parts: Sequence[AnimatedPart]) -> InputError:
    return InputError(f"{parts[0].owner.name}: it deforms no visible mesh; parent one to it")


def _vertices(part: VisibleMesh) -> Indices:
    """The vertices of a part in its mesh."""
    return np.arange(len(part.local), dtype=np.int32) if part.cropped is None else part.cropped.vertices


def _parts_of(mesh: VisibleMesh, regions: Regions) -> list[VisibleMesh]:
    """The parts of a mesh as those of another one with the same vertices."""
    return [
        replace(part, owner=mesh.owner, shown_in=mesh.shown_in, local=mesh.local[_vertices(part)], matrix=mesh.matrix)
        for part in regions.parts
    ]


def _local_matrices(rigs: Sequence[bpy.types.Object]) -> dict[tuple[str, str], Floats]:
    """The matrix of each bone relative to its parent, by rig and name."""
    bones = [(rig.name, bone) for rig in rigs for bone in rig.pose.bones if bone.parent is not None]
    return {(rig, bone.name): as_matrix(bone.parent.matrix.inverted_safe() @ bone.matrix) for rig, bone in bones}
