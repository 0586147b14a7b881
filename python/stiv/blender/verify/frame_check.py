# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a scene over frames, and of the ways between them: a pose may be free, and what leads to it not.

Between two frames each vertex is taken to move on a straight line, as motion blur and most simulations take it.
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
from stiv.blender.scene.assembly import Assembly, assemble, assemble_joined, mesh_seams, unjoined_triangles
from stiv.blender.scene.assembly import Element as FoundElement
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.blender.scene.evaluations import RENDER, VIEWPORT
from stiv.blender.settings import EditSettings
from stiv.blender.verify.event_elements import EventElements
from stiv.blender.verify.left_out import find_left_out
from stiv.blender.verify.scene_check import counted_names, find_pairs_and_seams
from stiv.checks.findings import CROSSING, Element, Finding, Look, SeamPairs, Shapes
from stiv.seams import Seams, common_seams


def check_frames(
    context: bpy.types.Context,
    frames: Sequence[float] = (),
    objects: Collection[str] = (),
    threads: int = 0,
    evaluations: Sequence[str] = (VIEWPORT, RENDER),
) -> Iterator[Look]:
    """Looks at the present pose, or with `frames` at each of them and at the way from each to the next.

    objects: names to be limited to. Whole and fractional frames may be mixed; they must ascend. evaluations: each is
    tested for itself; what is rendered as the viewport shows it is told once. The scene is left at the last frame.
    Raises InputError for unknown names and coordinates that are not finite.
    """
    _check_names(context, objects)
    before: dict[str, Pose] = {}
    for number, frame in enumerate(frames or (None,)):
        if frame is not None:
            go_to(context.scene, frame)
        present = _read(context, objects, evaluations, frame, threads)
        for evaluation in evaluations if before else ():
            if evaluation in before or evaluation in present:
                start, end = (poses.get(evaluation, poses[evaluations[0]]) for poses in (before, present))
                look = _between(start, end, evaluation, threads)
                yield look if evaluation == evaluations[0] else replace(look, notes=())
        tested = {name for pose in present.values() for name in pose.look.shapes.names}
        left_out = find_left_out(context, tested, objects) if number == 0 else ()
        for pose in present.values():
            yield replace(pose.look, untested=left_out)
        before = present


def go_to(scene: bpy.types.Scene, frame: float) -> None:
    """Makes a whole or fractional frame the scene's present one."""
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)


def scene_frames(context: bpy.types.Context) -> tuple[int, int]:
    """The scene's own range of frames."""
    return context.scene.frame_start, context.scene.frame_end


def shapes_of(assembly: Assembly, positions: Floats) -> Shapes:
    """The triangles of an assembly at positions of its surface, (N, 3), with the objects and faces they belong to."""
    names = tuple(dict.fromkeys(mesh.owner.name for mesh in assembly.meshes))
    owner = [np.full(len(mesh.triangles), names.index(mesh.owner.name), np.int32) for mesh in assembly.meshes]
    return Shapes(
        np.concatenate([np.empty((0, 3)), *(positions[assembly.vertices(k)] for k in range(len(assembly.meshes)))]),
        unjoined_triangles(assembly.meshes),
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
    """What an evaluation shows at a frame, and what was found in it."""

    assembly: Assembly
    look: Look


def _read(
    context: bpy.types.Context,
    objects: Collection[str],
    evaluations: Sequence[str],
    frame: float | None,
    threads: int,
) -> dict[str, Pose]:
    """The poses by evaluation; only those that show something otherwise than the first one."""
    is_counted = counted_names(context, EditSettings(), objects or None)
    scene = read_scene(context, is_counted, evaluations=evaluations, strands=True)
    poses = {}
    for number, evaluation in enumerate(evaluations):
        if number and all(mesh.exists_in >= set(evaluations) for mesh in scene.meshes):
            continue
        meshes = [mesh for mesh in scene.meshes if evaluation in mesh.exists_in]
        assembly = assemble_joined(meshes)
        look = _at_rest(assembly, evaluation, frame, threads)
        poses[evaluation] = Pose(assembly, replace(look, seams=()) if number else look)
    return poses


def _at_rest(assembly: Assembly, evaluation: str, frame: float | None, threads: int) -> Look:
    pairs, touching = find_pairs_and_seams(assembly, threads)
    found = [Finding(plain(p.first), plain(p.second), frame=frame, triangle_pairs=p.triangle_pairs) for p in pairs]
    seams = tuple(SeamPairs(name, "face", faces) for name, faces in touching if len(faces))
    told = _told_once(found, assembly, evaluation)
    return Look(shapes_of(assembly, assembly.positions), frame, None, told, seams=seams)


def _told_once(found: Sequence[Finding], assembly: Assembly, evaluation: str) -> tuple[Finding, ...]:
    """Of what is found in the render, only what involves an object that the viewport does not show so."""
    if evaluation != RENDER:
        return tuple(found)
    apart = {mesh.owner.name for mesh in assembly.meshes if VIEWPORT not in mesh.exists_in}
    return tuple(replace(each, rendered=True) for each in found if apart & {each.first.object, each.second.object})


def _between(start: Pose, end: Pose, evaluation: str, threads: int) -> Look:
    """The way from one frame to the next, of the meshes that both have.

    Pairs of objects that meet at one of the two frames were found there, and are left out.
    """
    assert start.look.frame is not None and end.look.frame is not None
    when = f"between frames {start.look.frame:g} and {end.look.frame:g}"
    pairs, notes = _matched(start.assembly, end.assembly, when)
    seams = [_seams_of_both(one, other) for one, other in pairs]
    moving = assemble([one for one, _ in pairs], [_mobility(one, other) for one, other in pairs], seams=seams)
    world = (moving.joined(place, other.world()) for place, (_, other) in enumerate(pairs))
    goal = np.concatenate([np.empty((0, 3)), *world])
    known = {finding.objects for look in (start.look, end.look) for finding in look.findings}
    found = [
        replace(each, frame=start.look.frame, to_frame=end.look.frame)
        for each in crossings(moving, goal, threads)
        if each.objects not in known
    ]
    first = min((finding.time for finding in found if finding.time is not None), default=0.0)
    shapes = shapes_of(moving, moving.positions + first * (goal - moving.positions))
    told = _told_once(found, moving, evaluation)
    return Look(shapes, start.look.frame, end.look.frame, told, tuple(notes))


def crossings(assembly: Assembly, goal: Floats, threads: int = 0) -> list[Finding]:
    """What meets while all vertices move in straight lines to `goal`, (N, 3): each pair once, at its earliest time."""
    if np.array_equal(assembly.positions, goal):
        return []
    events = stiv.Detector(assembly.surface, threads=threads).find(assembly.positions, goal)
    elements = EventElements(assembly, events)
    earliest: dict[tuple[Element, Element], float] = {}
    for number, time in enumerate(events.time.tolist()):
        first, second = (plain(each) for each in elements.of(number))
        pair = (min(first, second), max(first, second))
        earliest[pair] = min(time, earliest.get(pair, math.inf))
    return [Finding(a, b, CROSSING, time=time) for (a, b), time in sorted(earliest.items())]


def plain(element: FoundElement) -> Element:
    """An element of a scene as checks name it."""
    return Element(element.object, element.kind, element.number)


def _matched(before: Assembly, after: Assembly, when: str) -> tuple[list[tuple[VisibleMesh, VisibleMesh]], list[str]]:
    """Meshes that are there at both frames with the same vertices, and what was left out."""
    left = _by_name(after)
    pairs, notes = [], []
    for key, mesh in _by_name(before).items():
        other = left.pop(key, None)
        if other is None or len(other.local) != len(mesh.local) or len(other.triangles) != len(mesh.triangles):
            why = "comes or goes" if other is None else "changes its number of vertices or faces"
            notes.append(f'{when}: object "{mesh.owner.name}" {why}, and was not followed')
        elif mesh.strands is not None and not np.array_equal(mesh.local, other.local):
            notes.append(f'{when}: hair or curves of object "{mesh.owner.name}" move, and were not followed')
        else:
            pairs.append((mesh, other))
    notes += [f'{when}: object "{mesh.owner.name}" comes or goes, and was not followed' for mesh in left.values()]
    return pairs, notes


def _by_name(assembly: Assembly) -> dict[tuple[int, str, bool, int], VisibleMesh]:
    """Meshes by what keeps while frames change: owner, source, and the how-manieth of these."""
    found: dict[tuple[int, str, bool, int], VisibleMesh] = {}
    counts: dict[tuple[int, str, bool], int] = {}
    for mesh in assembly.meshes:
        name = (mesh.owner.session_uid, mesh.source, mesh.strands is not None)
        counts[name] = counts.get(name, -1) + 1
        found[*name, counts[name]] = mesh
    return found


def _mobility(one: VisibleMesh, other: VisibleMesh) -> str:
    """What keeps its shape cannot cross itself; its straight ways between frames would only make it seem to."""
    if one.strands is not None:
        return "fixed"
    return "rigid" if np.array_equal(one.local, other.local) else "deformable"


def _seams_of_both(one: VisibleMesh, other: VisibleMesh) -> Seams | None:
    """The seams of a mesh that stay closed from one frame to the next; what keeps its shape needs none."""
    if _mobility(one, other) != "deformable":
        return None
    return common_seams(*(mesh_seams(mesh.local, mesh.triangles) for mesh in (one, other)))
