# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of all meshes that rigs move, which Blender evaluates on hidden copies of rigs and meshes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

import stiv
from stiv.blender.controls.bone_channels import BoneChannels
from stiv.blender.controls.closed_seams import MergedRows, limit_to_closed, seams_of_part
from stiv.blender.controls.garments import Blocks, Garment, rows_of_blocks
from stiv.blender.controls.joint_regions import Joint, divide_all, joint_note, untested_parts
from stiv.blender.controls.rig_twin import MISSING, PosedMesh, RigTwin
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import kept_twin, kept_twins
from stiv.seams import Seams

TURNED = 1e-5  # change of a matrix above which a bone turns against its parent
LARGEST = float(np.finfo(np.float32).max)  # value of a channel
STEP = 0.01  # of the differences for a Jacobian: radians, factors, and diagonals of the surface
FAR = 0.5  # the same for poses that show which seams open


class PosedSurface:
    """The surface of meshes from the free channels of bones.

    Attributes:
        deformation: infeasible where the topology of a mesh differs from that at the start.
        start: scalars at the start, (k,).
        meshes: all meshes of the scene; those that the bones bend are divided at joints.
        surfaces: indices of those that the bones move.
        seams: for each of them, the vertices that stay together.
        opened: world positions of all vertices, (n, 3), at the pose nearest to the start in which one of these seams
            opened; None if none has.
        untested: pairs of parts that are not tested against each other.
        note: on the faces at joints; "" without any.
    """

    def __init__(
        self,
        bones: Sequence[BoneChannels],
        followers: frozenset[str],
        meshes: Sequence[VisibleMesh],
        weights: Sequence[Floats],
        joint_region: float,
        garments: Sequence[Garment] = (),
        torn: Sequence[Floats] = (),
    ) -> None:
        """followers: names of all objects that move with the rigs. weights: of the channels of each bone, (10,).

        joint_region: as in EditSettings. garments: yield; their controls follow the scalars in the deformation.
        torn: surfaces in which seams are open: `opened` of earlier ones.
        """
        scalars = BoneScalars(tuple(bones))
        followers = followers.union(*({meshes[k].owner.name for k in each.controls.surfaces} for each in garments))
        moved = [mesh for mesh in meshes if mesh.owner.name in followers]
        self.start = scalars.start
        with kept_twins():
            self._poses = _Poses(scalars, followers, moved, scalars.of(weights) > 0, _wear(garments, meshes, moved))
            jacobian, skins = self._poses.jacobian(), self._poses.weights()
            closed = self._poses.closed_seams(moved, jacobian, [values for _, values in skins], torn)
            regions = divide_all(moved, skins, self._poses.joints(), jacobian, joint_region, closed)
        waiting = iter(regions)
        divided = [next(waiting).parts if mesh.owner.name in followers else (mesh,) for mesh in meshes]
        self.meshes = tuple(part for parts in divided for part in parts)
        self.surfaces = tuple(k for k, mesh in enumerate(self.meshes) if mesh.owner.name in followers)
        self.seams = tuple(
            seams_of_part(own, part) for own, each in zip(closed, regions, strict=True) for part in each.parts
        )
        self.untested = untested_parts(moved, regions)
        self.note = joint_note(moved, regions)
        places = _places_of(moved, [self.meshes[k] for k in self.surfaces])
        vertices = MergedRows.of(places, self.seams, np.concatenate([mesh.world() for mesh in moved]))
        self._rows, self._merger = vertices.rows, _Merger(vertices, self.start)
        self.deformation = self._make_deformation(bones, scalars, jacobian, bool(garments))

    def _make_deformation(
        self, bones: Sequence[BoneChannels], scalars: BoneScalars, jacobian: Floats, has_garments: bool
    ) -> stiv.ScalarDeformation | stiv.ObservedDeformation:
        """The deformation by the scalars of bones, and by the controls of garments.

        Its functions do not refer to this object, which would then wait for a collection.
        """
        poses, merger = self._poses, self._merger
        lower, upper = (scalars.of(each) for each in ([b.lower for b in bones], [b.upper for b in bones]))

        def evaluate(values: Floats) -> Floats | None:
            return merger.merged(values, poses.evaluate(values))

        def evaluate_dressed(controls: Floats) -> Floats | None:
            values = controls[: len(lower), 0]
            if (values < lower).any() or (values > upper).any():
                return None
            return merger.merged(values, poses.evaluate(values, controls[len(lower) :]))

        if has_garments:
            with kept_twins():
                return stiv.observed(evaluate_dressed, poses.blocks(jacobian, self._rows))
        longest = scalars.of([each.longest_steps for each in bones])
        return stiv.scalars(evaluate, jacobian[self._rows], lower=lower, upper=upper, longest_step=longest)

    @property
    def opened(self) -> Floats | None:
        """See the attributes."""
        return self._merger.opened

    def renew_jacobian(self) -> None:
        """Measure the Jacobian at the last evaluation."""
        with kept_twins():
            jacobian = self._poses.jacobian()
            if isinstance(self.deformation, stiv.ScalarDeformation):
                self.deformation.set_jacobian(jacobian[self._rows])
            else:
                self.deformation.set_jacobian(self._poses.blocks(jacobian, self._rows))


class _Merger:
    """Merges seams, and stores the pose nearest to the start in which one opened. The core holds it, as `_Poses`."""

    def __init__(self, vertices: MergedRows, start: Floats) -> None:
        self._vertices, self._start = vertices, start
        self._distance = np.inf
        self.opened: Floats | None = None

    def merged(self, values: Floats, positions: Floats | None) -> Floats | None:
        """Positions of the vertices that remain, (k, 3), at scalars, (s,); None if a seam has opened."""
        points = None if positions is None else self._vertices.merged(positions)
        distance = float(np.linalg.norm(values - self._start))
        if positions is not None and points is None and distance < self._distance:
            self._distance, self.opened = distance, positions
        return points


@dataclass(frozen=True)
class _Worn:
    """A garment, its controls among those of all garments, and its vertices among those of all moved meshes."""

    garment: Garment
    controls: slice
    rows: Indices


def _wear(garments: Sequence[Garment], meshes: Sequence[VisibleMesh], moved: Sequence[VisibleMesh]) -> list[_Worn]:
    starts = np.cumsum([0, *(len(mesh.local) for mesh in moved)])
    place = {id(mesh): number for number, mesh in enumerate(moved)}
    found, first = [], 0
    for each in garments:
        numbers = [place[id(meshes[index])] for index in each.controls.surfaces]
        rows = np.concatenate([np.arange(starts[k], starts[k + 1], dtype=np.int32) for k in numbers])
        last = first + len(each.controls.controls)
        found.append(_Worn(each, slice(first, last), rows))
        first = last
    return found


def _places_of(meshes: Sequence[VisibleMesh], parts: Sequence[VisibleMesh]) -> list[Indices]:
    """For the vertices of each part, their numbers in the meshes, in turn."""
    starts = np.cumsum([0, *(len(mesh.local) for mesh in meshes)])
    firsts = np.cumsum([part.part == 0 for part in parts]) - 1
    own = [np.arange(len(part.local)) if part.cropped is None else part.cropped.vertices for part in parts]
    return [(starts[first] + vertices).astype(np.int32) for first, vertices in zip(firsts, own, strict=True)]


@dataclass(frozen=True)
class BoneScalars:
    """The free channels of bones as scalars, (k,)."""

    bones: tuple[BoneChannels, ...]

    @property
    def start(self) -> Floats:
        """Scalars at the start."""
        return self.of([bone.start for bone in self.bones])

    def of(self, channels: Sequence[Floats]) -> Floats:
        """The scalars of the channels of each bone, (10,)."""
        free = [values[bone.free] for bone, values in zip(self.bones, channels, strict=True)]
        return np.concatenate([np.empty(0), *free])

    def channels(self, scalars: Floats) -> Iterator[tuple[BoneChannels, Floats]]:
        """Each bone with its channels, (10,)."""
        first = 0
        for bone in self.bones:
            values = bone.start.copy()
            values[bone.free] = scalars[first : first + len(bone.free)]
            first += len(bone.free)
            yield bone, values


class _Poses:
    """Apart from `PosedSurface`, as the core holds `evaluate`: no cycle of references."""

    def __init__(
        self,
        scalars: BoneScalars,
        followers: frozenset[str],
        meshes: Sequence[VisibleMesh],
        responds: Flags,
        worn: Sequence[_Worn],
    ) -> None:
        self.scalars, self._followers, self._responds, self._worn = scalars, followers, responds, worn
        self._points = np.concatenate([np.empty((0, 3)), *(each.garment.controls.controls for each in worn)])
        self._owners = [(each.read_from, each.owner) for each in meshes]
        self._counts = [len(each.local) for each in meshes]
        self._last = scalars.start
        self._size = float(np.linalg.norm(np.ptp(np.concatenate([each.world() for each in meshes]), axis=0))) or 1.0
        self._turned: dict[tuple[int, str], bool] | None = None  # bones, and whether the goal turns them
        with kept_twins():
            self._start = self._observe(scalars.start)

    def evaluate(self, values: Floats, points: Floats | None = None) -> Floats | None:
        """World positions, (n, 3), at scalars, (k,), and controls of the garments, (m, 3); None: those before.

        None if the topology of a mesh differs, or if Blender cannot store the scalars: rounds that diverge try such.
        """
        if not np.abs(values).max(initial=0) <= LARGEST:
            return None
        self._points = self._points if points is None else points
        with kept_twins():
            found = self._observe(values)
        if not all(mesh.is_like(start) for mesh, start in zip(found, self._start, strict=True)):
            return None
        self._last = values
        return np.concatenate([each.world() for each in found])

    def jacobian(self) -> Floats:
        """One-sided differences at the last evaluation, (n, 3, k).

        0 where the topology changes, and for scalars that do not respond once the joints are known.
        """
        last = self._last.copy()
        here = self.evaluate(last)
        before = self._twin().local_matrices() if self._turned is None else {}
        turned: dict[tuple[int, str], bool] = {}
        given = self.scalars.of([np.full(10, bone.selected, float) for bone in self.scalars.bones])
        result = np.zeros((sum(self._counts), 3, len(last)))
        for k, step in enumerate(self._steps):
            if self._turned is not None and not self._responds[k]:
                continue
            moved = last.copy()
            moved[k] += step
            there = self.evaluate(moved)
            if here is not None and there is not None:
                result[:, :, k] = (there - here) / step
            if self._turned is None:
                after = self._twin().local_matrices()
                for bone in (each for each, old in before.items() if np.abs(old - after[each]).max() > TURNED):
                    turned[bone] = turned.get(bone, False) or bool(given[k])
        self._turned = turned if self._turned is None else self._turned
        self._last = last
        return result

    def closed_seams(
        self, meshes: Sequence[VisibleMesh], jacobian: Floats, weights: Sequence[Floats], torn: Sequence[Floats] = ()
    ) -> list[Seams | None]:
        """The seams of each mesh that stay closed: in the steps of the Jacobian, (n, 3, k), and in two other poses.

        weights: of bones at the vertices of each mesh, (n, g). torn: further surfaces, (n, 3).
        """
        seams = [mesh_seams(mesh.local, mesh.triangles) for mesh in meshes]
        if all(each is None for each in seams):
            return seams
        states, ends = [jacobian * self._steps, *self._far_states(), *torn], np.cumsum(self._counts)[:-1]
        own = zip(*(np.split(each, ends) for each in states), strict=True)
        return [limit_to_closed(*each) for each in zip(seams, meshes, own, weights, strict=True)]

    def _far_states(self) -> list[Floats]:
        """The surface, (n, 3), at two poses far from the last evaluation, with the garments moved at random."""
        values, points, random = self._last.copy(), self._points.copy(), np.random.default_rng(0)
        turns = random.choice([-1.0, 1.0], len(values)) * self._steps * (FAR / STEP)
        moves = random.uniform(-STEP, STEP, points.shape) * self._size
        found = [self.evaluate(values + sign * turns, points + sign * moves) for sign in (-1, 1)]
        self._last, self._points = values, points
        return [each for each in found if each is not None]

    def blocks(self, jacobian: Floats, rows: Indices) -> tuple[Indices, Indices, Floats, tuple[int, int]]:
        """The Jacobian of some rows by scalars and garments, as blocks, at the last evaluation.

        jacobian: by the scalars, (n, 3, k).
        """
        values, points, count = self._last.copy(), self._points.copy(), jacobian.shape[2]
        flags = (jacobian != 0).any(axis=1) & self._responds
        moving, scalar = (each.astype(np.int32) for each in np.nonzero(flags))
        found = [Blocks(moving, scalar, jacobian[moving, :, scalar][:, :, None] * np.array([1.0, 0, 0]))]
        for each in self._worn:

            def evaluate(controls: Floats, own: slice = each.controls) -> Floats | None:
                moved = points.copy()
                moved[own] = controls
                return self.evaluate(values, moved)

            blocks = each.garment.blocks(evaluate, points[each.controls], each.rows)
            found.append(replace(blocks, controls=blocks.controls + count + each.controls.start))
        self._last, self._points = values, points
        indptr, columns, data = rows_of_blocks(found, len(jacobian), rows)
        return indptr, columns, data, (len(rows), count + len(points))

    def joints(self) -> list[Joint]:
        """The bones that turn against their parents as the scalars change."""
        found = []
        for (number, name), is_given in sorted((self._turned or {}).items()):
            rig = next(each.rig for each in self.scalars.bones if each.rig.session_uid == number).find()
            bone = rig.pose.bones[name]
            names = frozenset({name, *(each.name for each in bone.children_recursive)})
            found.append(Joint(np.array(rig.matrix_world @ bone.head), names, not is_given))
        return found

    def weights(self) -> list[tuple[list[str], Floats]]:
        """Names of bones, and their weights at the vertices of each mesh, (n, g)."""
        return [
            self._twin(evaluation).weights(owner, count)
            for (evaluation, owner), count in zip(self._owners, self._counts, strict=True)
        ]

    def _twin(self, evaluation: str = "") -> RigTwin:
        chosen = evaluation or self._owners[0][0]
        return kept_twin((self, chosen), lambda: self._make_twin(chosen))

    @property
    def _steps(self) -> Floats:
        lengths = np.full(10, STEP)
        lengths[:3] = STEP * self._size
        return self.scalars.of([lengths] * len(self.scalars.bones))

    def _observe(self, values: Floats) -> list[PosedMesh]:
        """All meshes at scalars, (k,), in their order."""
        shown: dict[tuple[str, ObjectReference], list[PosedMesh]] = {}
        for evaluation in dict.fromkeys(read_from for read_from, _ in self._owners):
            twin = self._twin(evaluation)
            for each in self._worn:
                each.garment.write_copy(twin.copy_of(each.garment.controls.names[0]), self._points[each.controls])
            for owner, mesh in twin.evaluate(self.scalars.channels(values)):
                shown.setdefault((evaluation, owner), []).append(mesh)
        waiting = {key: iter(found) for key, found in shown.items()}
        return [next(waiting.get(key, iter(())), MISSING) for key in self._owners]

    def _make_twin(self, evaluation: str) -> RigTwin:
        rigs = [each.rig for each in self.scalars.bones]
        worn = frozenset(name for each in self._worn for name in each.garment.controls.names)
        return RigTwin(rigs, self._followers | worn, {owner for _, owner in self._owners}, evaluation, worn)
