# SPDX-License-Identifier: GPL-3.0-or-later
"""Excluded pairs of faces: those that intersect at the start of an edit may continue to."""

from __future__ import annotations

import zlib
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import PART, Element, FacePair, FacePairs
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import RENDER, SHOWN
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.scene.message_fitting import first_and_others, fit_message
from stiv.blender.scene.near_assembly import near_assembly
from stiv.touching import rounding_of

DEEPEST = 64  # of faces that only touch, in roundings: a session allows 16, and Blender's evaluation rounds again
_MOST_NOTES = 3  # of one kind that name objects


def exclude(pairs: Sequence[FacePair], meshes: Sequence[VisibleMesh]) -> Exclusions:
    """Exclude the given pairs of faces. Pairs with loose edges, loose vertices or strands cannot be excluded."""
    listed = FacePairs.of(pairs)
    faces = listed.chosen(listed.where(lambda first, second: first.kind == second.kind == "face"))
    chosen = Exclusions.of(*_keys_of(faces))
    return replace(chosen, shapes={name: _digest(meshes, name) for name in chosen.names})


def exclude_undecided(
    excluded: Exclusions, assembly: Assembly, found: Indices, together: Collection[str]
) -> Exclusions:
    """Also exclude the pairs of triangles, (k, 2), that intersect or touch and need no decision.

    together: names of objects, see `needs_no_decision`.
    """
    return _joined_undecided(excluded, assembly.face_pairs(found)[0], together)


def with_touching(
    excluded: Exclusions, assembly: Assembly, found: Indices, together: Collection[str]
) -> tuple[Exclusions, Exclusions]:
    """Exclusions with the excluded pairs of triangles of a session, (k, 2), that need no decision; and, apart from
    these, its pairs of objects that may touch, but not overlap.
    """
    pairs, _ = assembly.face_pairs(found)

    def touch(first: Element, second: Element) -> bool:
        return first.side != second.side and tuple(sorted((first.side, second.side))) not in excluded.objects

    are_touching = pairs.where(touch)
    joined = _joined_undecided(excluded, pairs.chosen(~are_touching), together)
    return joined, Exclusions.of(*_keys_of(pairs.chosen(are_touching)))


def _joined_undecided(excluded: Exclusions, pairs: FacePairs, together: Collection[str]) -> Exclusions:
    return excluded.joined(*_keys_of(pairs.chosen(pairs.where(partial(needs_no_decision, together=together)))))


def needs_no_decision(first: Element, second: Element, together: Collection[str]) -> bool:
    """May two elements intersect at the start: those of one object, or of objects that move `together`?"""
    return first.object == second.object or (first.object in together and second.object in together)


def pairs_of_objects(excluded: Exclusions) -> set[tuple[str, str]]:
    """The names of different objects with excluded faces, without the numbers of parts."""
    return {(a.partition(PART)[0], b.partition(PART)[0]) for a, b in excluded.objects}


def intersecting_faces(assembly: Assembly, found: Indices) -> tuple[tuple[str, str, int], ...]:
    """Pairs of different objects in pairs of triangles, (k, 2), with the number of their faces."""
    pairs = assembly.face_pairs(found)[0].by_objects()
    count = {names: sum(len(numbers) for _, numbers in own.faces()) for names, own in pairs.items()}
    return tuple((*names, count[names]) for names in sorted(count) if names[0] != names[1])


def intersection_text(first: str, second: str, count: int, ending: str = "") -> str:
    """ "A cuts B, 12 faces" with an ending, shortened to the length of a message in Blender."""
    return fit_message("{} cuts {}" + f", {count} faces{ending}", first, second)


def loose_geometry_text(first: str, second: str) -> str:
    """The message about loose edges or vertices of the first object that cut the second, which may be the same."""
    return fit_message("{}: loose geometry cuts {}; use Mesh > Clean Up > Delete Loose", first, second)


def intersects_itself(excluded: Exclusions, name: str) -> bool:
    """Are there excluded faces of an object and of the same object?"""
    return any({side.partition(PART)[0] for side in sides} == {name} for sides in excluded.faces)


def intersection_notes(
    excluded: Exclusions, moving: Collection[str], with_touching: Exclusions | None = None
) -> tuple[str, ...]:
    """Notes about objects that intersect themselves, and about pairs of objects: the first few, and how many more.

    moving: names of the objects that come first. with_touching: with pairs that only touch, which rounding may make
    intersect.
    """
    faces = _faces_of_objects(excluded)
    touching = faces if with_touching is None else _faces_of_objects(with_touching)
    rows = sorted(faces.items(), key=lambda row: (not any(name in moving for name in row[0]), row[0]))
    alone = [_note_of_one(names[0], count, touching[names]) for names, count in rows if names[0] == names[1]]
    pairs = [intersection_text(*names, count, ", may only part") for names, count in rows if names[0] != names[1]]
    return (
        *_first_of(pairs, "{} more pairs of objects cut each other, may only part"),
        *_first_of(alone, "{} more objects intersect themselves, left as they are"),
    )


def _faces_of_objects(excluded: Exclusions) -> dict[tuple[str, str], int]:
    """The number of excluded faces of each two objects, whose names are in ascending order, or of one."""
    faces: dict[tuple[str, str], list[NDArray[np.int64]]] = {}
    for sides, keys in excluded.faces.items():
        first, second = sorted(name.partition(PART)[0] for name in sides)
        faces.setdefault((first, second), []).append(keys)
    return {names: len(np.unique(np.concatenate(keys))) for names, keys in faces.items()}


def _first_of(notes: list[str], rest: str) -> list[str]:
    others = len(notes) - _MOST_NOTES
    return notes if others <= 1 else [*notes[:_MOST_NOTES], rest.format(others)]


def _note_of_one(name: str, cutting: int, with_touching: int) -> str:
    if with_touching > cutting:
        return fit_message("{}" + f" cuts or touches itself, {with_touching} faces, left as it is", name)
    return fit_message("{}" + f" intersects itself, {cutting} faces, left as it is", name)


def drop_stale(excluded: Exclusions, meshes: Sequence[VisibleMesh]) -> tuple[Exclusions, str]:
    """Drop the pairs of objects whose faces have changed; also returns a message about these objects, or "".

    Pairs of hidden objects remain and have no effect.
    """
    shown = {name for mesh in meshes for name in _names(mesh)}
    stale = {name for name, shape in excluded.shapes.items() if name in shown and _digest(meshes, name) != shape}
    if not stale:
        return excluded, ""
    return excluded.without(stale), _stale_text(sorted(stale))


def _stale_text(names: Sequence[str]) -> str:
    return fit_message("{}{}: the faces have changed, so their exclusions are dropped", *first_and_others(names))


def find_excluded_triangles(excluded: Exclusions, assembly: Assembly, q: Floats, threads: int = 0) -> Indices:
    """Find the pairs of triangles, (k, 2), of excluded faces of one object that intersect at positions, (N, 3)."""
    if len(excluded) == 0:
        return np.empty((0, 2), np.int32)
    found = stiv.find_intersections(q, assembly.surface, threads=threads)
    pairs, numbers = assembly.face_pairs(found)
    is_chosen = pairs.where(lambda a, b: a.side == b.side) & excluded.contains(*_keys_of(pairs))
    chosen: Indices = found[is_chosen[numbers]]
    return chosen


def excluded_bodies(excluded: Exclusions, assembly: Assembly) -> list[tuple[str | int, str | int]]:
    """Pairs of bodies of different objects, or parts of an object, with excluded faces."""
    bodies: dict[str, set[int]] = {}
    for mesh, start, end in zip(assembly.meshes, assembly.starts, assembly.starts[1:], strict=False):
        if end > start:
            side = Element(mesh.owner.name, "face", 0, part=mesh.part).side
            bodies.setdefault(side, set()).add(int(assembly.surface.vertex_body[start]))
    return [
        (a, b)
        for first, second in sorted(excluded.objects)
        for a in sorted(bodies.get(first, ()))
        for b in sorted(bodies.get(second, ()))
    ]


def has_only_excluded(
    excluded: Exclusions, touching: Exclusions, assembly: Assembly, q: Floats, threads: int = 0
) -> bool:
    """Is every intersection at positions, (N, 3), one that `find_forbidden` leaves out?"""
    near = near_assembly(assembly, q)
    return not find_forbidden(excluded, touching, near.assembly, near.extended(q), threads)


def find_forbidden(
    excluded: Exclusions, touching: Exclusions, assembly: Assembly, q: Floats, threads: int = 0
) -> FacePairs:
    """The intersections at positions, (N, 3), that are not excluded, nor of two objects with excluded faces, nor of
    touching faces that cut no deeper than rounding.
    """
    triangles = stiv.find_intersections(q, assembly.surface, threads=threads)
    found = find_face_pairs(assembly, q, threads, triangles)
    return found.chosen(~(are_excluded(excluded, found) | only_touch(touching, found, assembly, q, triangles)))


def only_touch(touching: Exclusions, found: FacePairs, assembly: Assembly, q: Floats, triangles: Indices) -> Flags:
    """Flags the pairs, (k,), of `find_face_pairs` that touch, and cut no deeper than rounding.

    triangles: the intersecting ones, (n, 2), at positions, (N, 3).
    """
    flags = touching.contains(*_keys_of(found))
    if flags.any():
        depths = stiv.intersection_depths(q, assembly.surface, triangles)
        are_deep = depths > DEEPEST * rounding_of(q[assembly.surface.triangles[triangles]])
        flags[assembly.face_pairs(triangles)[1][are_deep]] = False
    return flags


def excluded_within(excluded: Exclusions, mesh: VisibleMesh) -> NDArray[np.int64]:
    """Pairs of different faces of one mesh, or part of one, that are excluded, ascending, (m, 2)."""
    side = Element(mesh.owner.name, "face", 0, mesh.read_from, mesh.part)
    return excluded.within(_name(side.side, mesh.read_from))


def without_excluded(pairs: Sequence[FacePair], excluded: Exclusions) -> FacePairs:
    """The pairs that are not excluded, and not of two objects with excluded faces."""
    listed = FacePairs.of(pairs)
    return listed.chosen(~are_excluded(excluded, listed)) if len(excluded) else listed


def are_excluded(excluded: Exclusions, pairs: FacePairs) -> Flags:
    """Flags the pairs, (k,), that are excluded, or of two objects with excluded faces."""

    def are_objects_excluded(first: Element, second: Element) -> bool:
        a, b = sorted((first.side, second.side))
        return (a, b) in excluded.objects

    own = pairs.where(lambda first, second: first.side == second.side)
    return np.where(own, excluded.contains(*_keys_of(pairs)), pairs.where(are_objects_excluded))


def _keys_of(pairs: FacePairs) -> tuple[list[str], NDArray[np.int64]]:
    """Names and rows of pairs, as those of `Exclusions.of`. Loose elements get a number that no face has."""
    is_face = np.array([owner.kind == "face" for owner in pairs.owners], np.bool_)
    number = np.where(is_face[pairs.owner], pairs.number, -1)
    rows = np.stack([pairs.owner, number], axis=2).reshape(-1, 4).astype(np.int64)
    return [_name(owner.side, owner.evaluation) for owner in pairs.owners], rows


def _name(name: str, evaluation: str) -> str:
    """The object's name, extended by the evaluation where only the render shows the mesh."""
    return f"{name}\n{RENDER}" if evaluation == RENDER else name


def _names(mesh: VisibleMesh) -> set[str]:
    """The name under which faces of the mesh are excluded; none for strands and what only Edit Mode shows."""
    counts = mesh.shown_in != {SHOWN} and mesh.strands is None
    return {_name(mesh.owner.name, mesh.read_from)} if counts else set()


def _digest(meshes: Sequence[VisibleMesh], name: str) -> str:
    """Digest of the vertices of each face, independent of the triangulation."""
    value, counts = 0, []
    for mesh in meshes:
        if name in _names(mesh):
            belongs = np.unique(mesh.triangles.astype(np.int64) + (mesh.faces.astype(np.int64)[:, None] << 32))
            value = zlib.crc32(belongs.tobytes(), value)
            counts.append(len(mesh.local))
    return f"{counts}:{value:08x}"
