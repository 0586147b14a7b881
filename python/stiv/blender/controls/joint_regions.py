# SPDX-License-Identifier: GPL-3.0-or-later
"""Divides skin into the regions around joints, where it folds, and the limbs between them, which collide."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import Part
from stiv.blender.scene.evaluated_scene import CroppedMesh, VisibleMesh
from stiv.blender.scene.torn_seams import cutting_triangles
from stiv.seams import Seams

BLENDED = (0.02, 0.98)  # shares of a bone in vertices that its joint bends
YIELDING = 0.6  # part of the region at a joint that only responds, and thus turns little
BENDING = 0.02  # relative change of a squared length for a unit of a channel, beyond the error of differences
COLLAR = 1.25  # reach of the skin between a region and its limb, which both may touch, in reaches of the region
AT_JOINT = (0.25, 0.75)  # the same for those that lie around the joint


@dataclass(frozen=True)
class Joint:
    """A bone that turns against its parent.

    Attributes:
        head: (3,) in the world.
        bones: names of the bone and of those that follow it.
        yields: whether the goal does not turn it.
    """

    head: Floats
    bones: frozenset[str]
    yields: bool = False


@dataclass(frozen=True)
class Skin:
    """A mesh with the weights of bones: names of the groups, and their weights at each vertex, (n, g).

    seams: vertices of the mesh that stay together.
    """

    mesh: VisibleMesh
    groups: Sequence[str]
    weights: Floats
    seams: Seams | None = None

    @property
    def corners(self) -> Indices:
        """The triangles of the mesh, (f, 3), with the first copy of each vertex."""
        return self.mesh.triangles if self.seams is None else self.seams.leaders[self.mesh.triangles]

    @property
    def rows(self) -> Indices:
        """The corners, and after them loose edges as triangles whose last two corners are the same, (f + l, 3)."""
        loose = self.mesh.loose_edges if self.seams is None else self.seams.leaders[self.mesh.loose_edges]
        return np.concatenate([self.corners, loose[:, [0, 1, 1]]])

    @property
    def owners(self) -> Indices:
        """The face of each row, or a number of its own for a loose edge, (f + l,)."""
        faces = self.mesh.faces
        first = int(faces.max(initial=-1)) + 1
        return np.concatenate([faces, np.arange(first, first + len(self.mesh.loose_edges), dtype=np.int32)])

    @property
    def is_first(self) -> Flags:
        """Flags of the vertices that are the first of their copies, (n,)."""
        flags = np.ones(len(self.mesh.local), bool)
        if self.seams is not None:
            flags = self.seams.leaders == np.arange(len(flags))
        return flags

    def share(self, bones: frozenset[str]) -> Floats:
        """Share of some bones in each vertex, (n,)."""
        chosen = [name in bones for name in self.groups]
        share: Floats = self.weights[:, chosen].sum(axis=1) / self._total
        return share

    @cached_property
    def _total(self) -> Floats:
        total = self.weights.sum(axis=1)
        return np.where(total > 0, total, 1)


@dataclass(frozen=True)
class Regions:
    """A mesh in parts.

    Attributes:
        parts: the meshes; one if it has no joints.
        untested: pairs of parts that are not tested against each other, a part with itself included.
        joints: number of regions around joints; they are the first parts.
        faces: number of their faces.
        mates: further such pairs of a part and any other one.
    """

    parts: tuple[VisibleMesh, ...]
    untested: frozenset[tuple[int, int]]
    joints: int
    faces: int
    mates: frozenset[tuple[int, Part]] = frozenset()


@dataclass(frozen=True)
class Division:
    """A mesh in parts, and where its triangles are.

    Attributes:
        regions: the parts.
        labels: the part of each triangle, and after them of each loose edge, (f + l,).
        neighbours: pairs of parts that share a vertex, ascending.
    """

    regions: Regions
    labels: Indices
    neighbours: frozenset[tuple[int, int]]

    def touching(self, part: int) -> set[int]:
        """A part, and those that share a vertex with it."""
        return {part}.union(*(pair for pair in self.neighbours if part in pair))


def divide_all(
    meshes: Sequence[VisibleMesh],
    weights: Sequence[tuple[Sequence[str], Floats]],
    joints: Sequence[Joint],
    jacobian: Floats,
    radii: float,
    seams: Sequence[Seams | None] = (),
) -> list[Regions]:
    """Divide meshes with the weights of bones at their vertices; jacobian: of all their vertices, (n, 3, k).

    seams: vertices of each mesh that stay together; empty for none. A mesh that bends without weights of its own is not
    tested against itself.
    """
    joins = tuple(seams) or (None,) * len(meshes)
    skins = [Skin(mesh, *each, own) for mesh, each, own in zip(meshes, weights, joins, strict=True)]
    mating = find_mating(skins, joints if radii > 0 else ())
    divisions = [divide(skin, joints, radii, own) for skin, own in zip(skins, mating.vertices, strict=True)]
    found = [replace(each.regions, mates=mates) for each, mates in zip(divisions, mating.mates(divisions), strict=True)]
    ends = np.cumsum([len(mesh.local) for mesh in meshes])[:-1]
    for number, (mesh, rows) in enumerate(zip(meshes, np.split(jacobian, ends), strict=True)):
        if radii > 0 and not found[number].joints and _bends(mesh, rows):
            found[number] = replace(found[number], untested=frozenset({(0, 0)}))
    return found


def part_of(mesh: VisibleMesh, number: int) -> Part:
    """A part of a mesh by number."""
    return mesh.owner.name, mesh.shown_in, number


def untested_parts(meshes: Sequence[VisibleMesh], regions: Sequence[Regions]) -> frozenset[tuple[Part, Part]]:
    """All pairs of parts of meshes that are not tested."""
    found: set[tuple[Part, Part]] = set()
    for mesh, each in zip(meshes, regions, strict=True):
        found |= {(part_of(mesh, a), part_of(mesh, b)) for a, b in each.untested}
        found |= {(part_of(mesh, a), other) for a, other in each.mates}
    return frozenset(found)


def smallest_altitude(mesh: VisibleMesh) -> float:
    """Altitude that 95 % of the triangles with an area exceed, in the world; infinite without any."""
    a, b, c = (mesh.world()[mesh.triangles[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.max([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    altitudes = area[area > 0] / longest[area > 0]
    return float(np.quantile(altitudes, 0.05)) if len(altitudes) else float("inf")


def joint_note(meshes: Sequence[VisibleMesh], regions: Sequence[Regions]) -> str:
    """The message on the faces that may fold; "" if there are none."""
    folding = [(mesh, each) for mesh, each in zip(meshes, regions, strict=True) if each.faces]
    if not folding:
        return ""
    name, faces = folding[0][0].owner.name, sum(each.faces for _, each in folding)
    return f"{name}: {faces:,} faces at joints may fold into each other"


def _bends(mesh: VisibleMesh, jacobian: Floats) -> bool:
    """Do edges change their length?"""
    points, corners = mesh.world(), mesh.triangles
    a, b = np.concatenate([corners[:, :2], corners[:, 1:]]).T
    along = points[b] - points[a]
    change = np.einsum("ni,nik->nk", along, jacobian[b] - jacobian[a])
    return bool((np.abs(change) > BENDING * (along * along).sum(axis=1)[:, None] + 1e-12).any())


def divide(
    skin: Skin, joints: Sequence[Joint], radii: float, mating: Mapping[int, Indices] = MappingProxyType({})
) -> Division:
    """Divide a mesh.

    radii: distance from a joint that its region reaches, in radii of the limb; 0 leaves no region. mating: by number of
    a joint, the vertices of triangles that cut others across it.
    """
    mesh, corners, owners = skin.mesh, skin.rows, skin.owners
    around, beside = np.zeros((2, len(mesh.local)), bool)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    for number, joint in enumerate(joints if radii > 0 else ()):
        vertices = mating.get(number, np.empty(0, np.int32))
        around |= _region(skin, joint, radii, edges, vertices)
        beside |= _region(skin, joint, COLLAR * radii, edges, vertices)
    in_joint = _of_faces(owners, np.any(around[corners], axis=1))
    if not in_joint.any():
        return Division(Regions((mesh,), frozenset(), 0, 0), np.zeros(len(corners), np.int32), frozenset())
    beside[corners[in_joint]] = True
    in_collar = _of_faces(owners, np.any(beside[corners], axis=1)) & ~in_joint
    labels, count = _label(corners, [in_joint, in_collar, ~(in_joint | in_collar)])
    labels = _with_islands_joined(labels, count, _neighbours(corners, labels))
    neighbours = _neighbours(corners, labels)
    untested = neighbours | {(number, number) for number in range(count)}
    parts = tuple(_part(mesh, number, labels == number) for number in range(labels.max() + 1))
    faces = np.unique(mesh.faces[in_joint[: len(mesh.faces)]])
    return Division(Regions(parts, frozenset(untested), count, len(faces)), labels, frozenset(neighbours))


def _of_faces(owners: Indices, rows: Flags) -> Flags:
    """All triangles of the faces that have one of the triangles flagged in `rows`."""
    chosen = np.zeros(int(owners.max(initial=-1)) + 1, bool)
    chosen[owners[rows]] = True
    flags: Flags = chosen[owners]
    return flags


@dataclass(frozen=True)
class Mating:
    """Triangles that cut each other at the start, and that a joint turns against each other.

    The stiff pieces of a machine have no skin that bends; what they have in common at a joint is this.

    Attributes:
        meshes: all.
        vertices: for each mesh, the vertices of such triangles by number of the joint.
        pairs: mesh and triangle of both, (k, 4).
    """

    meshes: Sequence[VisibleMesh]
    vertices: Sequence[Mapping[int, Indices]]
    pairs: Indices

    def mates(self, divisions: Sequence[Division]) -> list[frozenset[tuple[int, Part]]]:
        """Of each mesh, the parts around joints that cut others there, and each with the neighbours of the other."""
        parts = [each.labels for each in divisions]
        first, second = (_gather(parts, self.pairs[:, k : k + 2]) for k in (0, 2))
        rows = np.unique(np.stack([self.pairs[:, 0], first, self.pairs[:, 2], second], axis=1), axis=0)
        found: list[set[tuple[int, Part]]] = [set() for _ in divisions]
        for a, p, b, q in rows.tolist():
            if p < divisions[a].regions.joints and q < divisions[b].regions.joints and (a, p) != (b, q):
                found[a] |= {(each, part_of(self.meshes[b], q)) for each in divisions[a].touching(p)}
                found[a] |= {(p, part_of(self.meshes[b], each)) for each in divisions[b].touching(q)}
        return [frozenset(each) for each in found]


def find_mating(skins: Sequence[Skin], joints: Sequence[Joint]) -> Mating:
    """The triangles of meshes that joints turn against each other and that cut at the start."""
    vertices: list[dict[int, Indices]] = [{} for _ in skins]
    pairs = [np.empty((0, 4), np.int32)]
    for evaluation in dict.fromkeys(skin.mesh.read_from for skin in skins) if joints else ():
        numbers = [number for number, skin in enumerate(skins) if skin.mesh.read_from == evaluation]
        cuts = _cuts([skins[number] for number in numbers])
        cuts[:, ::2] = np.array(numbers, np.int32)[cuts[:, ::2]]
        for place, joint in enumerate(joints if len(cuts) else ()):
            follows = [skin.share(joint.bones)[skin.corners].mean(axis=1) >= 0.5 for skin in skins]
            between = cuts[_gather(follows, cuts[:, :2]) != _gather(follows, cuts[:, 2:])]
            mesh, triangle = between.reshape(-1, 2).T
            for number in np.unique(mesh).tolist():
                vertices[number][place] = skins[number].corners[triangle[mesh == number]].ravel()
            pairs.append(between)
    return Mating([skin.mesh for skin in skins], vertices, np.concatenate(pairs))


def _gather(values: Sequence[NDArray[Any]], places: Indices) -> NDArray[Any]:
    """The values of triangles by mesh and number, (k, 2)."""
    starts = np.cumsum([0, *map(len, values)])[:-1]
    return np.concatenate(values)[starts[places[:, 0]] + places[:, 1]]


def _cuts(skins: Sequence[Skin]) -> Indices:
    """Mesh and triangle of each two that cut each other, (k, 4)."""
    counts = [len(skin.mesh.local) for skin in skins]
    starts = np.cumsum([0, *counts]).astype(np.int32)
    points = np.concatenate([skin.mesh.world() for skin in skins])
    corners = [skin.corners + start for skin, start in zip(skins, starts[:-1], strict=True)]
    found = cutting_triangles(points, np.concatenate(corners))
    ends = np.cumsum([len(each) for each in corners])
    mesh = np.searchsorted(ends, found, side="right")
    triangle = found - np.concatenate([[0], ends])[mesh]
    return np.stack([mesh, triangle], axis=2).reshape(-1, 4).astype(np.int32)


def _region(skin: Skin, joint: Joint, radii: float, edges: Indices, mating: Indices) -> Flags:
    """The vertices around a joint, (n,): connected to those that it bends or that mate there, and near it."""
    share = skin.share(joint.bones)
    bent = (share > BLENDED[0]) & (share < BLENDED[1])
    crossing = (share[edges] < 0.5).any(axis=1) & (share[edges] >= 0.5).any(axis=1)
    bent[edges[crossing]] = True
    bent[mating] = True
    bent &= skin.is_first
    if not bent.any():
        return bent
    distance = np.linalg.norm(skin.mesh.world() - joint.head, axis=1)
    middle = bent & (share > AT_JOINT[0]) & (share < AT_JOINT[1])
    reach = YIELDING * radii if joint.yields else radii
    near = distance <= reach * float(np.median(distance[middle if middle.any() else bent]))
    return _reached(bent & near, near, edges)


def _reached(start: Flags, allowed: Flags, edges: Indices) -> Flags:
    """The allowed vertices that edges between allowed ones connect with the start."""
    inside = edges[allowed[edges].all(axis=1)]
    found, before = start.copy(), -1
    while (count := int(found.sum())) != before:
        before = count
        found[inside[found[inside].any(axis=1)]] = True
    return found


def _components(count: int, faces: Indices) -> Indices:
    """For each vertex, the smallest vertex that faces, (f, 3), connect with it, (n,)."""
    label = np.arange(count, dtype=np.int32)
    while True:
        least = label.copy()
        np.minimum.at(least, faces.ravel(), np.repeat(label[faces].min(axis=1), faces.shape[1]))
        least = least[least]
        if np.array_equal(least, label):
            return label
        label = least


def _label(corners: Indices, kinds: Sequence[Flags]) -> tuple[Indices, int]:
    """The part of each triangle, (f,): a connected piece of its kind; and the number of parts of the first kind."""
    labels, count, firsts = np.zeros(len(corners), np.int32), 0, []
    for rows in kinds:
        pieces = _components(int(corners.max()) + 1, corners[rows])[corners[rows, 0]]
        names, numbers = np.unique(pieces, return_inverse=True)
        labels[rows] = count + numbers.ravel()
        count += len(names)
        firsts.append(count)
    return labels, firsts[0]


def _with_islands_joined(labels: Indices, count: int, neighbours: set[tuple[int, int]]) -> Indices:
    """The parts with all that touch no other one, except the first `count`, as one part."""
    touching = np.zeros(int(labels.max()) + 1, bool)
    touching[[number for pair in neighbours for number in pair]] = True
    touching[:count] = True
    new = np.where(touching, np.cumsum(touching) - 1, int(touching.sum())).astype(np.int32)
    joined: Indices = new[labels]
    return joined


def _neighbours(corners: Indices, labels: Indices) -> set[tuple[int, int]]:
    """Pairs of parts that share a vertex."""
    rows = np.unique(np.stack([corners.ravel(), np.repeat(labels, 3)], axis=1), axis=0)
    same = rows[1:, 0] == rows[:-1, 0]  # of three parts at a vertex, the first and the last are compared below
    far = rows[2:, 0] == rows[:-2, 0]
    pairs = [(rows[:-1, 1][same], rows[1:, 1][same]), (rows[:-2, 1][far], rows[2:, 1][far])]
    return {(int(one), int(other)) for ones, others in pairs for one, other in zip(ones, others, strict=True)}


def _part(mesh: VisibleMesh, number: int, rows: Flags) -> VisibleMesh:
    """Some triangles of a mesh, and after them some of its loose edges."""
    chosen, loose = np.split(rows, [len(mesh.triangles)])
    used = np.zeros(len(mesh.local), bool)
    used[mesh.triangles[chosen]] = True
    used[mesh.loose_edges[loose]] = True
    vertices, place = np.flatnonzero(used).astype(np.int32), (np.cumsum(used) - 1).astype(np.int32)
    local, triangles, faces = mesh.local[vertices], place[mesh.triangles[chosen]], mesh.faces[chosen]
    edges, numbers = place[mesh.loose_edges[loose]], mesh.loose_numbers[loose]
    cropped = CroppedMesh(vertices, local, triangles, faces, edges, numbers, len(mesh.local))
    return replace(
        mesh, local=local, triangles=triangles, faces=faces, loose_edges=edges, loose_numbers=numbers, cropped=cropped,
        part=number,
    )  # fmt: skip
