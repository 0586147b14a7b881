# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's evaluation back after a write, and tests it."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import Element, FacePair, FacePairs, count_faces, sides_of
from stiv.blender.scene.evaluated_scene import (
    EvaluatedPositions,
    evaluation_tolerance,
    read_positions_of,
    view_positions_of,
)
from stiv.blender.scene.evaluations import RENDER, SHOWN, VIEWPORT
from stiv.blender.scene.exclusions import are_excluded, find_forbidden, only_touch
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.scene.merged_modes import Placed, read_apart
from stiv.blender.scene.modifier_stack import simulation_error
from stiv.blender.scene.open_evaluations import OpenEvaluations, open_evaluations
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.triangulation_flips import (
    CurrentTriangulation,
    FaceTriangles,
    find_flips,
    is_deformable,
    with_current_triangulation,
)
from stiv.blender.verify.both_diagonals import BothDiagonals
from stiv.points import largest_difference

SPLITTING = ("TRIANGULATE", "NODES")  # modifiers that may split quads along another diagonal as they bend
SAMPLED = 16  # one point of 16 mostly shows that a surface is as large as needed
StepTest = Callable[[Floats, Floats], bool]


@dataclass(frozen=True)
class Verification:
    """The result of a test of Blender's evaluation. If it failed, `message` gives the reason.

    `flips` are triangles of Blender's present triangulation that intersect. An edit avoids them if they are part of the
    surface.
    """

    passed: bool
    intersections: Sequence[FacePair] = ()
    message: str = ""
    flips: tuple[FaceTriangles, ...] = ()


class Verifier:
    """Tests Blender's evaluation against accepted surfaces of an `assembly`."""

    def __init__(
        self,
        assembly: Assembly,
        is_step_free: StepTest,
        threads: int = 0,
        excluded: Exclusions | None = None,
        touching: Exclusions | None = None,
        names_pairs: bool = True,
    ) -> None:
        """Test the meshes of an assembly; threads 0 uses all cores. Excluded pairs may intersect, and those that touch
        by as much as rounding moves them.

        is_step_free: stiv.StepCheck.is_free of its surface, or the method of an EditSession. names_pairs: find the
        pairs that intersect if a step is not free, which takes longer than the test.
        """
        self.assembly = assembly
        self._threads = threads
        self._is_step_free = is_step_free
        self._excluded, self._touching = excluded or Exclusions(), touching or Exclusions()
        self._names_pairs = names_pairs
        self._diagonals = BothDiagonals(assembly, threads)

    def tests(self, assembly: Assembly, excluded: Exclusions, touching: Exclusions) -> bool:
        """Is this the verifier of an assembly and its exclusions? They may change during an edit."""
        return self.assembly is assembly and (self._excluded, self._touching) == (excluded, touching)

    def verify(self, context: bpy.types.Context, accepted: Floats) -> Verification:
        """Test Blender's present evaluation against the accepted surface, (N, 3), which is free of intersections.

        Both surfaces must agree up to single precision, with a free step between them. The evaluation must be free of
        intersections in the assembly's triangulation and in Blender's present one, which depends on the shape. Raises
        SceneChangedError if other meshes are visible than at the start.
        """
        with _opened(context, self.assembly) as opened:
            return self._verify(context, accepted, opened)

    def _verify(self, context: bpy.types.Context, accepted: Floats, opened: OpenEvaluations) -> Verification:
        placed = _read_placed(self.assembly, opened)
        result = self._verify_placed(context, accepted, opened, self.assembly, placed)
        for assembly, other in read_apart(self.assembly, placed, opened) if result.passed else ():
            result = self._verify_placed(context, accepted, opened, assembly, other)
        return result

    def _verify_placed(
        self,
        context: bpy.types.Context,
        accepted: Floats,
        opened: OpenEvaluations,
        assembly: Assembly,
        placed: Placed,
    ) -> Verification:
        """Test positions of the meshes; the assembly says from which evaluations they were read."""
        meshes = _world(assembly, placed)
        shown = _merged(assembly, meshes)
        message = _displacement_message(assembly, accepted, meshes)
        if message:
            return Verification(False, (), message)
        if len(self._excluded) or len(self._touching):
            pairs = self._not_excluded(accepted, shown)
            if pairs:
                return self._failure(pairs)
        elif not self._is_step_free(accepted, shown):
            return self._failure(find_face_pairs(self.assembly, shown, self._threads) if self._names_pairs else ())
        flips = self._find_flips(context, assembly, placed, opened, shown)
        return self._verify_flips(flips, shown) if flips else Verification(True)

    def _find_flips(
        self,
        context: bpy.types.Context,
        assembly: Assembly,
        placed: Placed,
        opened: OpenEvaluations,
        shown: Floats,
    ) -> tuple[CurrentTriangulation, ...]:
        """Find the meshes with present triangles that are not tested yet. Most triangulations need not be read."""
        local = {
            number: each.local
            for number, (each, mesh) in enumerate(zip(placed, self.assembly.meshes, strict=True))
            if each is not None and is_deformable(self.assembly, number) and not _may_split(mesh.owner.find())
        }
        uncertain = self._diagonals.find_uncertain(local)
        if self._diagonals.are_free(uncertain, local, shown):
            flips = find_flips(context, assembly, opened, uncertain.__contains__)
            if not flips:
                return ()
        return find_flips(context, assembly, opened, lambda number: not len(uncertain.get(number, [number])))

    def _not_excluded(self, accepted: Floats, shown: Floats) -> FacePairs:
        """Intersecting pairs of a surface that are not excluded, or of excluded objects that the edit has parted.

        Only the end of the step is tested; the step is shorter than the rounding of single precision.
        """
        triangles = stiv.find_intersections(shown, self.assembly.surface, threads=self._threads)
        found = find_face_pairs(self.assembly, shown, self._threads, triangles)
        excluded = are_excluded(self._excluded, found)
        between = excluded & found.where(lambda first, second: first.side != second.side)
        if between.any():
            overlapping = find_face_pairs(self.assembly, accepted, self._threads).sides()
            excluded &= ~(between & found.where(lambda *both: sides_of(*both) not in overlapping))
        return found.chosen(~(excluded | only_touch(self._touching, found, self.assembly, shown, triangles)))

    def _verify_flips(self, flips: tuple[CurrentTriangulation, ...], shown: Floats) -> Verification:
        current = with_current_triangulation(self.assembly, flips)
        pairs = find_forbidden(self._excluded, self._touching, current, shown, self._threads)
        if not pairs:
            return Verification(True)
        intersecting = {each for pair in pairs for each in (pair.first, pair.second)}
        return self._failure(pairs, tuple(self._intersecting_triangles(flip.new, intersecting) for flip in flips))

    def _intersecting_triangles(self, flip: FaceTriangles, intersecting: set[Element]) -> FaceTriangles:
        mesh = self.assembly.meshes[flip.mesh]
        return flip.limited_to(
            np.array(
                [
                    Element(mesh.owner.name, "face", int(face), mesh.read_from, mesh.part) in intersecting
                    for face in flip.faces
                ]
            )
        )

    def _failure(self, pairs: Sequence[FacePair], flips: tuple[FaceTriangles, ...] = ()) -> Verification:
        if not pairs:
            return Verification(False, (), "surfaces come too close in Blender; use a larger minimum distance")
        return Verification(False, pairs, _intersection_message(pairs), flips)


def _may_split(ob: bpy.types.Object) -> bool:
    """May modifiers split the quads that are shown? A subdivision makes quads again."""
    for modifier in reversed(ob.modifiers):
        if isinstance(modifier, bpy.types.SubsurfModifier) and modifier.show_viewport and modifier.levels:
            return False
        if modifier.type in SPLITTING:
            return True
    return False


def read_shown(context: bpy.types.Context, assembly: Assembly) -> Floats:
    """World positions of the assembly's meshes in Blender's present evaluation, (N, 3)."""
    with _opened(context, assembly) as opened:
        return _merged(assembly, _world(assembly, _read_placed(assembly, opened)))


def _read_placed(assembly: Assembly, opened: OpenEvaluations) -> Placed:
    """Positions of each mesh in Blender's present evaluation; None for strands.

    Strands are not read again: edits leave out those that depend on moving objects.
    """
    placed: list[EvaluatedPositions] = []
    meshes = [mesh for mesh in assembly.meshes if mesh.strands is None]
    whole = [mesh for mesh in meshes if not mesh.is_static]
    for read_from in dict.fromkeys(mesh.read_from for mesh in whole):
        owners = frozenset(mesh.owner.session_uid for mesh in whole if mesh.read_from == read_from)
        if read_from in opened.read_from:
            placed += read_positions_of(owners, opened, read_from)
    static = {(mesh.owner.session_uid, mesh.static) for mesh in meshes if mesh.is_static}
    if static:  # parts of obstacles, after all other meshes
        placed += view_positions_of(static, opened)
    firsts = np.cumsum([mesh.part == 0 for mesh in meshes]) - 1  # parts of a mesh follow each other
    if max(firsts, default=-1) + 1 == len(placed):
        placed = [placed[first] for first in firsts]
    if [_identity(each) for each in placed] != [(mesh.size, mesh.owner.session_uid) for mesh in meshes]:
        raise SceneChangedError("objects were shown, hidden or changed during the edit; begin again")
    control_sets = iter(
        each if mesh.cropped is None else each.limited_to(mesh.cropped.vertices)
        for each, mesh in zip(placed, meshes, strict=True)
    )
    return [next(control_sets) if mesh.strands is None else None for mesh in assembly.meshes]


def _world(assembly: Assembly, placed: Placed) -> list[Floats]:
    """World positions of each mesh, seams not merged."""
    pairs = zip(placed, assembly.meshes, strict=True)
    return [mesh.world() if each is None else each.world() for each, mesh in pairs]


def _merged(assembly: Assembly, meshes: Sequence[Floats]) -> Floats:
    joined = (assembly.merge_seams(number, points) for number, points in enumerate(meshes))
    return np.concatenate([np.empty((0, 3)), *joined])


@contextmanager
def _opened(context: bpy.types.Context, assembly: Assembly) -> Iterator[OpenEvaluations]:
    """The evaluations from which the meshes of an assembly were read."""
    if all(mesh.read_from == SHOWN and not mesh.also_in for mesh in assembly.meshes):
        yield OpenEvaluations(context)
        return
    with open_evaluations(context, frozenset().union(*(mesh.shown_in for mesh in assembly.meshes))) as opened:
        yield opened


def _identity(placed: EvaluatedPositions) -> tuple[int, int]:
    return len(placed.local), placed.owner.session_uid


def _displacement_message(assembly: Assembly, accepted: Floats, meshes: Sequence[Floats]) -> str:
    for number, mesh in enumerate(assembly.meshes):
        control_set = slice(assembly.starts[number], assembly.starts[number + 1])
        whole = accepted[control_set] if assembly.seams[number] is None else accepted[assembly.vertices(number)]
        difference = largest_difference(meshes[number], whole)
        if difference and _exceeds_tolerance(difference, accepted[control_set]):  # mostly 0 for obstacles
            if error := simulation_error(mesh.owner.find(), VIEWPORT):
                return str(error)
            if len(mesh.owner.find().modifiers) > 0:
                return f"{mesh.owner.name}: its modifiers cannot be followed ({difference:.3g}); apply them"
            return f"{mesh.owner.name}: Blender shows it {difference:.3g} away from the solved position"
    return ""


def _exceeds_tolerance(difference: float, points: Floats) -> bool:
    """Do evaluations of points, (n, 3), differ by more than rounding? The tolerance of some points is not greater."""
    if difference <= evaluation_tolerance(points[::SAMPLED]):
        return False
    return not difference <= evaluation_tolerance(points)


def _intersection_message(pairs: Sequence[FacePair]) -> str:
    first, second = pairs[0].first, pairs[0].second
    shown_in = {VIEWPORT: "Object Mode", RENDER: "the render"}.get(second.evaluation, "the viewport")
    faces = count_faces(pairs)
    counted = "1 face" if faces == 1 else f"{faces:,} faces"
    if first.object == second.object:
        return f"{first.object} cuts itself in {shown_in}, {counted}"
    return f"{first.object} cuts {second.object} in {shown_in}, {counted}"
