# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests a scene exactly, at frames and between them.

Between two frames, each vertex moves along a straight line, as motion blur and most simulations assume.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly, assemble, assemble_with_seams, mesh_seams, unmerged_triangles
from stiv.blender.scene.elements import Element as FoundElement
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.blender.scene.evaluations import RENDER, VIEWPORT
from stiv.blender.scene.face_pairs import EventElements
from stiv.blender.scene.passing import passing_note, passing_pairs
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import find_pairs_and_seams, tested_names
from stiv.blender.verify.untested import find_untested
from stiv.checks.findings import CROSSING, Element, Finding, Look, SeamPairs, Shapes
from stiv.seams import Seams, common_seams


def check_frames(
    context: bpy.types.Context,
    frames: Sequence[float] = (),
    objects: Collection[str] = (),
    threads: int = 0,
    evaluations: Sequence[str] = (VIEWPORT, RENDER),
) -> Iterator[Look]:
    """Test the present pose, or each of `frames` and the motion to the next.

    objects: names to test; empty for all. Frames ascend and may be fractional. evaluations: each is tested separately;
    what the render shares with the viewport is reported once. The scene ends at the last frame. Raises InputError for
    unknown names and coordinates that are not finite.
    """
    _check_names(context, objects)
    before: dict[str, Pose] = {}
    for number, frame in enumerate(frames or (None,)):
        if frame is not None:
            set_frame(context.scene, frame)
        present = _read(context, objects, evaluations, frame, threads)
        for evaluation in evaluations if before else ():
            if evaluation in before or evaluation in present:
                start, end = (poses.get(evaluation, poses[evaluations[0]]) for poses in (before, present))
                look = _test_motion(start, end, evaluation, threads)
                yield look if evaluation == evaluations[0] else replace(look, notes=())
        tested = {name for pose in present.values() for name in pose.look.shapes.names}
        untested = find_untested(context, tested, objects) if number == 0 else ()
        note = passing_note(passing_pairs(context.scene)) if number == 0 else ""
        for pose in present.values():
            yield replace(pose.look, untested=untested, notes=(note,) if note else ())
        before = present


def set_frame(scene: bpy.types.Scene, frame: float) -> None:
    """Set the scene to a whole or fractional frame."""
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)


def scene_frames(context: bpy.types.Context) -> tuple[int, int]:
    """The scene's frame range."""
    return context.scene.frame_start, context.scene.frame_end


def shapes_of(assembly: Assembly, positions: Floats) -> Shapes:
    """Triangles of an assembly at surface positions, (N, 3), with their objects and faces."""
    names = tuple(dict.fromkeys(mesh.owner.name for mesh in assembly.meshes))
    owner = [np.full(len(mesh.triangles), names.index(mesh.owner.name), np.int32) for mesh in assembly.meshes]
    return Shapes(
        np.concatenate([np.empty((0, 3)), *(positions[assembly.vertices(k)] for k in range(len(assembly.meshes)))]),
        unmerged_triangles(assembly.meshes),
        names,
        np.concatenate([np.empty(0, np.int32), *owner]),
        np.concatenate([np.empty(0, np.int32), *(mesh.faces for mesh in assembly.meshes)]),
    )


def _check_names(context: bpy.types.Context, objects: Collection[str]) -> None:
    unknown = sorted(set(objects) - set(context.scene.objects.keys()))
    if unknown:
        raise InputError(f'there is no object "{unknown[0]}" in the scene')


@dataclass(frozen=True)
class Pose:
    """An evaluation at one frame, the intersections in it, and pairs of names that were not tested."""

    assembly: Assembly
    look: Look
    passing: tuple[tuple[str, str], ...] = ()


def _read(
    context: bpy.types.Context, objects: Collection[str], evaluations: Sequence[str], frame: float | None, threads: int
) -> dict[str, Pose]:
    """Poses by evaluation; evaluations equal to the first are left out."""
    is_counted = tested_names(context, EditSettings(), objects or None)
    scene = read_scene(context, is_counted, evaluations=evaluations, strands=True)
    passing = passing_pairs(context.scene)
    poses = {}
    for number, evaluation in enumerate(evaluations):
        if number and all(mesh.shown_in >= set(evaluations) for mesh in scene.meshes):
            continue
        meshes = [mesh for mesh in scene.meshes if evaluation in mesh.shown_in]
        assembly = assemble_with_seams(meshes, passing)
        look = _test_pose(assembly, evaluation, frame, threads)
        poses[evaluation] = Pose(assembly, replace(look, seams=()) if number else look, passing)
    return poses


def _test_pose(assembly: Assembly, evaluation: str, frame: float | None, threads: int) -> Look:
    pairs, touching = find_pairs_and_seams(assembly, threads)
    found = [
        Finding(to_report_element(p.first), to_report_element(p.second), frame=frame, triangle_pairs=p.triangle_pairs)
        for p in pairs
    ]
    seams = tuple(SeamPairs(name, "face", faces) for name, faces in touching if len(faces))
    reported = _without_repeats(found, assembly, evaluation)
    return Look(shapes_of(assembly, assembly.positions), frame, None, reported, seams=seams)


def _without_repeats(found: Sequence[Finding], assembly: Assembly, evaluation: str) -> tuple[Finding, ...]:
    """Leave out findings in the render that the viewport shows alike."""
    if evaluation != RENDER:
        return tuple(found)
    apart = {mesh.owner.name for mesh in assembly.meshes if VIEWPORT not in mesh.shown_in}
    return tuple(replace(each, rendered=True) for each in found if apart & {each.first.object, each.second.object})


def _test_motion(start: Pose, end: Pose, evaluation: str, threads: int) -> Look:
    """Test the motion from one frame to the next, of the meshes that both frames have.

    Pairs of objects that intersect at one of the two frames were reported there, and are left out.
    """
    assert start.look.frame is not None and end.look.frame is not None
    when = f"between frames {start.look.frame:g} and {end.look.frame:g}"
    pairs, notes = _match_meshes(start.assembly, end.assembly, when)
    seams = [_seams_of_both(one, other) for one, other in pairs]
    mobility = [_mobility(one, other) for one, other in pairs]
    moving = assemble([one for one, _ in pairs], mobility, ignored=start.passing, seams=seams)
    world = (moving.merge_seams(place, other.world()) for place, (_, other) in enumerate(pairs))
    goal = np.concatenate([np.empty((0, 3)), *world])
    known = {finding.objects for look in (start.look, end.look) for finding in look.findings}
    found = [
        replace(each, frame=start.look.frame, to_frame=end.look.frame)
        for each in crossings(moving, goal, threads)
        if each.objects not in known
    ]
    first = min((finding.time for finding in found if finding.time is not None), default=0.0)
    shapes = shapes_of(moving, moving.positions + first * (goal - moving.positions))
    reported = _without_repeats(found, moving, evaluation)
    return Look(shapes, start.look.frame, end.look.frame, reported, tuple(notes))


def crossings(assembly: Assembly, goal: Floats, threads: int = 0) -> list[Finding]:
    """Find collisions while all vertices move linearly to `goal`, (N, 3): each pair at its earliest time."""
    if np.array_equal(assembly.positions, goal):
        return []
    events = stiv.Detector(assembly.surface, threads=threads).find(assembly.positions, goal)
    elements = EventElements(assembly, events)
    earliest: dict[tuple[Element, Element], float] = {}
    for number, time in enumerate(events.time.tolist()):
        first, second = (to_report_element(each) for each in elements.of(number))
        pair = (min(first, second), max(first, second))
        earliest[pair] = min(time, earliest.get(pair, math.inf))
    return [Finding(a, b, CROSSING, time=time) for (a, b), time in sorted(earliest.items())]


def to_report_element(element: FoundElement) -> Element:
    """An element as reports name it."""
    return Element(element.object, element.kind, element.number)


def _match_meshes(
    before: Assembly, after: Assembly, when: str
) -> tuple[list[tuple[VisibleMesh, VisibleMesh]], list[str]]:
    """Meshes that both frames have with the same vertices, and notes about the others."""
    left = _by_name(after)
    pairs, notes = [], []
    for key, mesh in _by_name(before).items():
        other = left.pop(key, None)
        if other is None or len(other.local) != len(mesh.local) or len(other.triangles) != len(mesh.triangles):
            why = "appears or disappears" if other is None else "changes its number of vertices or faces"
            notes.append(f'{when}: object "{mesh.owner.name}" {why}, and was left out')
        elif mesh.strands is not None and not np.array_equal(mesh.local, other.local):
            notes.append(f'{when}: hair or curves of object "{mesh.owner.name}" move, and were left out')
        else:
            pairs.append((mesh, other))
    notes += [f'{when}: object "{mesh.owner.name}" appears or disappears, and was left out' for mesh in left.values()]
    return pairs, notes


def _by_name(assembly: Assembly) -> dict[tuple[int, str, bool, int], VisibleMesh]:
    """Meshes by the properties that frames share: owner, source, whether strands, and a running number."""
    found: dict[tuple[int, str, bool, int], VisibleMesh] = {}
    counts: dict[tuple[int, str, bool], int] = {}
    for mesh in assembly.meshes:
        name = (mesh.owner.session_uid, mesh.source, mesh.strands is not None)
        counts[name] = counts.get(name, -1) + 1
        found[*name, counts[name]] = mesh
    return found


def _mobility(one: VisibleMesh, other: VisibleMesh) -> str:
    """Undeformed meshes are rigid: with linear motion, a rotating mesh would appear to intersect itself."""
    if one.strands is not None:
        return "fixed"
    return "rigid" if np.array_equal(one.local, other.local) else "deformable"


def _seams_of_both(one: VisibleMesh, other: VisibleMesh) -> Seams | None:
    """Seams of a deforming mesh that stay closed from one frame to the next."""
    if _mobility(one, other) != "deformable":
        return None
    return common_seams(*(mesh_seams(mesh.local, mesh.triangles) for mesh in (one, other)))
