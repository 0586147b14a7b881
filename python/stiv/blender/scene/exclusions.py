# SPDX-License-Identifier: GPL-3.0-or-later
"""Excluded pairs of faces: those that intersect at the start of an edit may continue to."""

from __future__ import annotations

import zlib
from collections.abc import Sequence

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import Element, FacePair
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import RENDER, SHOWN
from stiv.blender.settings import Exclusions, FaceKey

_MOST_CHARACTERS = 80  # of a message in Blender


def exclude(pairs: Sequence[FacePair], meshes: Sequence[VisibleMesh]) -> Exclusions:
    """Exclude the given pairs of faces. Pairs with loose edges, loose vertices or strands cannot be excluded."""
    chosen = frozenset(_key(pair.first, pair.second) for pair in pairs if pair.first.kind == pair.second.kind == "face")
    names = {name for pair in chosen for name, _ in pair}
    return Exclusions(chosen, {name: _digest(meshes, name) for name in sorted(names)})


def exclude_self_intersections(excluded: Exclusions, assembly: Assembly, found: Indices) -> Exclusions:
    """Also exclude the intersecting pairs of triangles, (k, 2), whose triangles belong to one object."""
    pairs = ((assembly.face(a), assembly.face(b)) for a, b in found.tolist())
    own = frozenset(_key(a, b) for a, b in pairs if a.object == b.object)
    return Exclusions(excluded.pairs | own, excluded.shapes)


def self_intersection_notes(excluded: Exclusions) -> tuple[str, ...]:
    """A note for each object that has excluded pairs of its own faces, with their number."""
    faces: dict[str, set[int]] = {}
    for (first, number), (second, other) in excluded.pairs:
        if first == second:
            faces.setdefault(first.partition("\n")[0], set()).update((number, other))
    return tuple(_self_intersection_note(name, len(numbers)) for name, numbers in sorted(faces.items()))


def _self_intersection_note(name: str, count: int) -> str:
    text = f" intersects itself, {count} faces, left as it is"
    return _shortened(name, _MOST_CHARACTERS - len(text)) + text


def _shortened(name: str, most: int) -> str:
    return name if len(name) <= most else f"{name[: most - 1]}…"


def drop_stale(excluded: Exclusions, meshes: Sequence[VisibleMesh]) -> tuple[Exclusions, str]:
    """Drop the pairs of objects whose faces have changed; also returns a message that names these objects, or "".

    Pairs of hidden objects remain and have no effect.
    """
    shown = {name for mesh in meshes for name in _names(mesh)}
    stale = {name for name, shape in excluded.shapes.items() if name in shown and _digest(meshes, name) != shape}
    if not stale:
        return excluded, ""
    pairs = frozenset(pair for pair in excluded.pairs if not {name for name, _ in pair} & stale)
    shapes = {name: shape for name, shape in excluded.shapes.items() if name not in stale}
    names = ", ".join(sorted(stale))
    return Exclusions(pairs, shapes), f"{names}: the faces have changed, so their exclusions are dropped"


def find_excluded_triangles(excluded: Exclusions, assembly: Assembly, q: Floats, threads: int = 0) -> Indices:
    """Find the pairs of triangles, (k, 2), of excluded faces that intersect at positions, (N, 3)."""
    if not excluded.pairs:
        return np.empty((0, 2), np.int32)
    found = stiv.find_intersections(q, assembly.surface, threads=threads)
    rows = [_key(assembly.face(a), assembly.face(b)) in excluded.pairs for a, b in found.tolist()]
    chosen: Indices = found[np.array(rows, bool)]
    return chosen


def has_only_excluded(excluded: Exclusions, assembly: Assembly, q: Floats, threads: int = 0) -> bool:
    """Is every intersection at positions, (N, 3), between excluded faces?"""
    found = stiv.find_intersections(q, assembly.surface, threads=threads)
    if not excluded.pairs:
        return len(found) == 0
    return all(_key(assembly.face(a), assembly.face(b)) in excluded.pairs for a, b in found.tolist())


def without_excluded(pairs: Sequence[FacePair], excluded: Exclusions) -> tuple[FacePair, ...]:
    """The pairs that are not excluded."""
    return tuple(pair for pair in pairs if _key(pair.first, pair.second) not in excluded.pairs)


def _key(first: Element, second: Element) -> tuple[FaceKey, FaceKey]:
    """Both elements in ascending order. Loose elements get a number that no face has."""
    a, b = (
        (_name(each.object, each.evaluation), each.number if each.kind == "face" else -1) for each in (first, second)
    )
    return (a, b) if a <= b else (b, a)


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
