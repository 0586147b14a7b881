# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of faces that the user excludes: they may intersect, not more of them than did, and all others stay guarded."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

import stiv
from stiv import InputError
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import RENDER, SHOWN

if TYPE_CHECKING:
    from stiv.blender.scene.assembly import Assembly, Element
    from stiv.blender.verify.verification import FacePair

End = tuple[str, int]  # object, number of a face of its evaluated mesh


@dataclass(frozen=True)
class Exclusions:
    """Pairs of faces, and what the objects looked like for which their numbers hold.

    Attributes:
        pairs: both ends of each, the smaller one first.
        shapes: by object name, a digest of its evaluated faces; pairs of one that has changed are stale.
    """

    pairs: frozenset[tuple[End, End]] = frozenset()
    shapes: Mapping[str, str] = field(default_factory=dict)

    @staticmethod
    def of(pairs: Sequence[FacePair], meshes: Sequence[VisibleMesh]) -> Exclusions:
        """Those among pairs that meet which are pairs of faces; what is loose cannot be excluded."""
        kept = frozenset(
            _ordered(pair.first, pair.second) for pair in pairs if pair.first.kind == pair.second.kind == "face"
        )
        names = {name for pair in kept for name, _ in pair}
        return Exclusions(kept, {name: _digest(meshes, name) for name in sorted(names)})

    @staticmethod
    def from_json(text: str) -> Exclusions:
        """What `to_json` wrote; "" are none. Raises InputError for anything else."""
        if not text:
            return Exclusions()
        try:
            data = json.loads(text)
            pairs = frozenset(((str(a), int(i)), (str(b), int(j))) for a, i, b, j in data["pairs"])
            return Exclusions(pairs, {str(name): str(shape) for name, shape in data["shapes"].items()})
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise InputError("the excluded pairs kept in the scene cannot be read; clear them") from error

    def to_json(self) -> str:
        """For a text property of the scene; "" for none."""
        if not self.pairs:
            return ""
        return json.dumps({"pairs": [[a, i, b, j] for (a, i), (b, j) in sorted(self.pairs)], "shapes": {**self.shapes}})

    def current(self, meshes: Sequence[VisibleMesh]) -> tuple[Exclusions, str]:
        """Without the pairs of objects that are there with other faces now, and a message that names those objects.

        Pairs of objects that are not visible stay, and do nothing.
        """
        shown = {name for mesh in meshes for name in _names(mesh)}
        stale = {name for name, shape in self.shapes.items() if name in shown and _digest(meshes, name) != shape}
        if not stale:
            return self, ""
        kept = frozenset(pair for pair in self.pairs if not {name for name, _ in pair} & stale)
        shapes = {name: shape for name, shape in self.shapes.items() if name not in stale}
        names = ", ".join(f'"{name}"' for name in sorted(stale))
        count = len(self.pairs) - len(kept)
        return Exclusions(kept, shapes), f"excluded pairs are dropped ({count}): the faces of {names} have changed"

    def triangles(self, assembly: Assembly, q: Floats, threads: int = 0) -> Indices:
        """Pairs of triangles, (k, 2), that meet at positions, (N, 3), and belong to excluded pairs of faces."""
        if not self.pairs:
            return np.empty((0, 2), np.int32)
        meeting = stiv.find_intersections(q, assembly.surface, threads=threads)
        rows = [_ordered(assembly.face(a), assembly.face(b)) in self.pairs for a, b in meeting.tolist()]
        chosen: Indices = meeting[np.array(rows, bool)]
        return chosen

    def allow(self, assembly: Assembly, q: Floats, threads: int = 0) -> bool:
        """Are all pairs of triangles that meet at positions, (N, 3), excluded?"""
        meeting = stiv.find_intersections(q, assembly.surface, threads=threads)
        if not self.pairs:
            return len(meeting) == 0
        return all(_ordered(assembly.face(a), assembly.face(b)) in self.pairs for a, b in meeting.tolist())

    def others(self, pairs: Sequence[FacePair]) -> tuple[FacePair, ...]:
        """Those among pairs that are not excluded."""
        return tuple(pair for pair in pairs if _ordered(pair.first, pair.second) not in self.pairs)


def _ordered(first: Element, second: Element) -> tuple[End, End]:
    """Loose elements get numbers that no face has."""
    a, b = (
        (_name(each.object, each.evaluation), each.number if each.kind == "face" else -1) for each in (first, second)
    )
    return (a, b) if a <= b else (b, a)


def _name(name: str, evaluation: str) -> str:
    """An object's own name, with that of the evaluation for what is only rendered."""
    return f"{name}\n{RENDER}" if evaluation == RENDER else name


def _names(mesh: VisibleMesh) -> set[str]:
    """What the mesh is called: as in the viewport, as in the render; as in Edit Mode alone, and strands, have none."""
    counts = mesh.exists_in != {SHOWN} and mesh.strands is None
    return {_name(mesh.owner.name, mesh.read_in)} if counts else set()


def _digest(meshes: Sequence[VisibleMesh], name: str) -> str:
    """Of which vertices belong to which face in all that an object shows, however Blender cuts faces."""
    value, counts = 0, []
    for mesh in meshes:
        if name in _names(mesh):
            belongs = np.unique(mesh.triangles.astype(np.int64) + (mesh.faces.astype(np.int64)[:, None] << 32))
            value = zlib.crc32(belongs.tobytes(), value)
            counts.append(len(mesh.local))
    return f"{counts}:{value:08x}"
