# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own evaluation after writing, read back and tested."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
import numpy as np

import stiv
from stiv.blender.controls.control_reading import tolerance
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly, Element
from stiv.blender.scene.errors import SceneChangedError
from stiv.blender.scene.evaluated_scene import Opened, Placed, open_evaluations, read_placed
from stiv.blender.scene.evaluations import RENDER, SHOWN, VIEWPORT
from stiv.blender.scene.exclusions import Exclusions
from stiv.blender.scene.triangulation_flips import Cut, PresentCut, as_shown, fresh_cuts

StepTest = Callable[[Floats, Floats], bool]


@dataclass(frozen=True)
class FacePair:
    """Two elements that meet, the second always a face, and how many pairs of their triangles do."""

    first: Element
    second: Element
    triangle_pairs: int = field(default=1, compare=False)


@dataclass(frozen=True)
class Verification:
    """Did what Blender shows pass? If not, `message` says why, with the pairs that meet.

    `cuts` are the triangles by which Blender's present cut of faces that bent makes them meet: with them in the
    surface, an edit avoids it.
    """

    passed: bool
    intersections: tuple[FacePair, ...] = ()
    message: str = ""
    cuts: tuple[Cut, ...] = ()


class Verifier:
    """Tests what Blender evaluates against accepted surfaces of an `assembly`."""

    def __init__(
        self, assembly: Assembly, is_step_free: StepTest, threads: int = 0, excluded: Exclusions | None = None
    ) -> None:
        """For the meshes of an assembly; threads 0 for all. Excluded pairs may meet, no more of them than at first.

        is_step_free: stiv.StepCheck.is_free of its surface, or the same of an EditSession.
        """
        self.assembly = assembly
        self._threads = threads
        self._is_step_free = is_step_free
        self._excluded = excluded or Exclusions()
        self._most = len(self._excluded.triangles(assembly, assembly.positions, threads))

    def verify(self, context: bpy.types.Context, accepted: Floats) -> Verification:
        """Test what Blender evaluates now against the accepted surface, (N, 3), which is free of intersections.

        It must be where the accepted surface is, to within single precision; the way there must be free; and it must
        be free of intersections, in the triangles of the assembly and in Blender's present ones, which follow the
        shape. Raises SceneChangedError when other meshes are visible than at the start.
        """
        with _opened(context, self.assembly) as opened:
            return self._verify(context, accepted, opened)

    def _verify(self, context: bpy.types.Context, accepted: Floats, opened: Opened) -> Verification:
        meshes = _read_meshes(self.assembly, opened)
        shown = _joined(self.assembly, meshes)
        message = _elsewhere(self.assembly, accepted, meshes)
        if message:
            return Verification(False, (), message)
        if self._most:
            found = self._beside_excluded(shown)
            if found is not None:
                return found
        elif not self._is_step_free(accepted, shown):
            return self._failure(named_pairs(self.assembly, shown, self._threads))
        cuts = fresh_cuts(context, self.assembly, opened)
        return self._verify_cuts(cuts, shown) if cuts else Verification(True)

    def _beside_excluded(self, shown: Floats) -> Verification | None:
        """What is wrong where excluded pairs meet: others do, or more of them do. The step is not looked at, only its
        end: it is no longer than the rounding of single precision.
        """
        pairs = self._excluded.others(named_pairs(self.assembly, shown, self._threads))
        if pairs:
            return self._failure(pairs)
        if len(self._excluded.triangles(self.assembly, shown, self._threads)) > self._most:
            return Verification(False, (), "more of the excluded pairs would meet in what Blender shows")
        return None

    def _verify_cuts(self, cuts: tuple[PresentCut, ...], shown: Floats) -> Verification:
        pairs = self._excluded.others(named_pairs(as_shown(self.assembly, cuts), shown, self._threads))
        if not pairs:
            return Verification(True)
        meeting = {each for pair in pairs for each in (pair.first, pair.second)}
        return self._failure(pairs, tuple(self._that_meet(cut.fresh, meeting) for cut in cuts))

    def _that_meet(self, cut: Cut, meeting: set[Element]) -> Cut:
        mesh = self.assembly.meshes[cut.mesh]
        return cut.limited_to(
            np.array([Element(mesh.owner.name, "face", int(face), mesh.read_in) in meeting for face in cut.faces])
        )

    def _failure(self, pairs: tuple[FacePair, ...], cuts: tuple[Cut, ...] = ()) -> Verification:
        if not pairs:
            return Verification(False, (), "what Blender shows comes too near; use a larger separation")
        return Verification(False, pairs, _told(pairs), cuts)


def read_shown(context: bpy.types.Context, assembly: Assembly) -> Floats:
    """World positions of the assembly's meshes as Blender evaluates them now, (N, 3)."""
    with _opened(context, assembly) as opened:
        return _joined(assembly, _read_meshes(assembly, opened))


def _read_meshes(assembly: Assembly, opened: Opened) -> list[Floats]:
    """World positions of each mesh as Blender evaluates it now, vertices of seams each by itself.

    Strands stay where they were read: edits leave out those that depend on what moves.
    """
    placed: list[Placed] = []
    meshes = [mesh for mesh in assembly.meshes if mesh.strands is None]
    for read_in in dict.fromkeys(mesh.read_in for mesh in meshes):
        owners = frozenset(mesh.owner.session_uid for mesh in meshes if mesh.read_in == read_in)
        if read_in in opened.read_in:
            placed += read_placed(owners, opened, read_in)
    if [_shape(each) for each in placed] != [(mesh.size, mesh.owner.session_uid) for mesh in meshes]:
        raise SceneChangedError("objects were shown, hidden or changed in size during the edit")
    parts = iter(
        each if mesh.near is None else each.limited_to(mesh.near.vertices)
        for each, mesh in zip(placed, meshes, strict=True)
    )
    return [next(parts).world() if mesh.strands is None else mesh.world() for mesh in assembly.meshes]


def _joined(assembly: Assembly, meshes: Sequence[Floats]) -> Floats:
    joined = (assembly.joined(number, points) for number, points in enumerate(meshes))
    return np.concatenate([np.empty((0, 3)), *joined])


@contextmanager
def _opened(context: bpy.types.Context, assembly: Assembly) -> Iterator[Opened]:
    """The evaluations that the meshes of an assembly were read from."""
    if all(mesh.read_in == SHOWN for mesh in assembly.meshes):
        yield Opened(context)
        return
    with open_evaluations(context, frozenset().union(*(mesh.exists_in for mesh in assembly.meshes))) as opened:
        yield opened


def named_pairs(
    assembly: Assembly, q: Floats, threads: int = 0, meeting: Indices | None = None
) -> tuple[FacePair, ...]:
    """All pairs that meet at positions `q`, (N, 3), each once; loose edges and vertices included.

    meeting: pairs of triangles that meet, (k, 2); None: all that do.
    """
    faces = stiv.find_intersections(q, assembly.surface, threads=threads) if meeting is None else meeting
    edges, vertices = stiv.find_loose_intersections(q, assembly.surface, threads=threads)
    counts = Counter(
        [
            *((assembly.face(a), assembly.face(b)) for a, b in faces.tolist()),
            *((assembly.loose_edge(a), assembly.face(b)) for a, b in edges.tolist()),
            *((assembly.vertex(a), assembly.face(b)) for a, b in vertices.tolist()),
        ]
    )
    for first, second in [pair for pair in counts if pair[0] != pair[1] and pair[::-1] in counts]:
        if (first, second) in counts:  # triangles of one face may come after those of another, and before them
            counts[first, second] += counts.pop((second, first))
    return tuple(FacePair(first, second, number) for (first, second), number in counts.items())


def _shape(placed: Placed) -> tuple[int, int]:
    return len(placed.local), placed.owner.session_uid


def _elsewhere(assembly: Assembly, accepted: Floats, meshes: Sequence[Floats]) -> str:
    for number, mesh in enumerate(assembly.meshes):
        part = slice(assembly.starts[number], assembly.starts[number + 1])
        whole = accepted[part] if assembly.seams[number] is None else accepted[assembly.vertices(number)]
        difference = float(np.abs(meshes[number] - whole).max(initial=0.0))
        if not difference <= tolerance(accepted[part]):
            return f'object "{mesh.owner.name}": Blender shows it {difference:.3g} away from where it was to be'
    return ""


def _told(pairs: tuple[FacePair, ...]) -> str:
    first, second = pairs[0].first, pairs[0].second
    shown_in = {VIEWPORT: "what Object Mode shows", RENDER: "the render"}.get(second.evaluation, "what Blender shows")
    return (
        f"{len(pairs)} pairs meet in {shown_in}, the first are "
        f'object "{first.object}", {first.kind} {first.number} and '
        f'object "{second.object}", {second.kind} {second.number}'
    )
