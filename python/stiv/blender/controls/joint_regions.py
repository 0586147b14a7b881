# SPDX-License-Identifier: GPL-3.0-or-later
"""Divides skin into the regions around joints, where it folds, and the limbs between them, which collide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluated_scene import CroppedMesh, VisibleMesh
from stiv.blender.scene.torn_seams import cutting_triangles, self_cuts
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
        total = self.weights.sum(axis=1)
        share: Floats = self.weights[:, chosen].sum(axis=1) / np.where(total > 0, total, 1)
        return share


@dataclass(frozen=True)
class Regions:
    """A mesh in parts.

    Attributes:
        parts: the meshes; one if it has no joints.
        untested: pairs of parts that are not tested against each other, a part with itself included.
        joints: number of regions around joints.
        faces: number of their faces.
    """

    parts: tuple[VisibleMesh, ...]
    untested: frozenset[tuple[int, int]]
    joints: int
    faces: int


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
    found, first, joins = [], 0, tuple(seams) or (None,) * len(meshes)
    for mesh, (groups, values), own in zip(meshes, weights, joins, strict=True):
        rows = jacobian[first : first + len(mesh.local)]
        first += len(mesh.local)
        regions = Regions((mesh,), frozenset(), 0, 0)
        if len(groups):
            regions = divide(Skin(mesh, groups, values, own), joints, radii)
        if radii > 0 and not regions.joints and _bends(mesh, rows):
            regions = replace(regions, untested=frozenset({(0, 0)}))
        found.append(regions)
    return found


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


def fold_note(
    assembly: Assembly, surfaces: Sequence[int], untested: frozenset[tuple[str, int, int]], q: Floats, threads: int = 0
) -> str:
    """The message on untested faces that cut into each other at positions `q`, (N, 3), and did not at the start.

    "" if there are none. surfaces: numbers of the meshes that bones bend. untested: pairs of their parts.
    """
    for numbers in _divided_meshes(assembly, surfaces):
        name = assembly.meshes[numbers[0]].owner.name
        parts = frozenset((a, b) for owner, a, b in untested if owner == name)
        found = _folds(assembly, numbers, parts, q, threads)
        folded = found and found - _folds(assembly, numbers, parts, assembly.positions, threads)
        if folded:
            return f"{name}: {len(frozenset().union(*folded)):,} faces at joints cut into each other"
    return ""


def _divided_meshes(assembly: Assembly, surfaces: Sequence[int]) -> list[list[int]]:
    """The numbers of the parts of each mesh; an object may show one mesh in the viewport and another in the render."""
    found: list[list[int]] = []
    for number in surfaces:
        if assembly.meshes[number].part == 0:
            found.append([])
        found[-1].append(number)
    return found


def _folds(
    assembly: Assembly, numbers: Sequence[int], untested: frozenset[tuple[int, int]], q: Floats, threads: int
) -> set[frozenset[int]]:
    """Pairs of faces of one mesh that intersect at positions `q`, (N, 3), in parts that are not tested."""
    meshes = [assembly.meshes[number] for number in numbers]
    if not untested:
        return set()
    rows = [np.arange(len(each.local)) if each.cropped is None else each.cropped.vertices for each in meshes]
    count = max(int(each.max(initial=-1)) for each in rows) + 1
    points = np.tile(q[assembly.starts[numbers[0]]], (count, 1))  # also of vertices without faces
    for number, each in zip(numbers, rows, strict=True):
        points[each] = q[assembly.vertices(number)]
    corners = np.concatenate([each[mesh.triangles] for each, mesh in zip(rows, meshes, strict=True)])
    part = {face: mesh.part for mesh in meshes for face in mesh.faces.tolist()}
    pairs = self_cuts(points, corners, np.concatenate([mesh.faces for mesh in meshes]), threads)

    def is_untested(pair: frozenset[int]) -> bool:
        a, b = (part[face] for face in pair)
        return (a, b) in untested or (b, a) in untested

    return set(filter(is_untested, pairs))


def _bends(mesh: VisibleMesh, jacobian: Floats) -> bool:
    """Do edges change their length?"""
    points, corners = mesh.world(), mesh.triangles
    a, b = np.concatenate([corners[:, :2], corners[:, 1:]]).T
    along = points[b] - points[a]
    change = np.einsum("ni,nik->nk", along, jacobian[b] - jacobian[a])
    return bool((np.abs(change) > BENDING * (along * along).sum(axis=1)[:, None] + 1e-12).any())


def divide(skin: Skin, joints: Sequence[Joint], radii: float) -> Regions:
    """Divide a mesh.

    radii: distance from a joint that its region reaches, in radii of the limb; 0 leaves no region.
    """
    if radii <= 0 or not joints:
        return Regions((skin.mesh,), frozenset(), 0, 0)
    mesh, corners, owners = skin.mesh, skin.rows, skin.owners
    around, beside = np.zeros((2, len(mesh.local)), bool)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    cuts = cutting_triangles(mesh.world(), skin.corners)
    mating = [cuts[_lies_between(skin, joint, cuts)] for joint in joints]
    for joint, pairs in zip(joints, mating, strict=True):
        around |= _region(skin, joint, radii, edges, pairs)
        beside |= _region(skin, joint, COLLAR * radii, edges, pairs)
    in_joint = _of_faces(owners, np.any(around[corners], axis=1))
    if not in_joint.any():
        return Regions((mesh,), frozenset(), 0, 0)
    beside[corners[in_joint]] = True
    in_collar = _of_faces(owners, np.any(beside[corners], axis=1)) & ~in_joint
    labels, count = _label(corners, [in_joint, in_collar, ~(in_joint | in_collar)])
    labels = _with_islands_joined(labels, count, _neighbours(corners, labels))
    neighbours = _neighbours(corners, labels)
    pairs = np.concatenate(mating)
    mated = _mated(labels[pairs[in_joint[pairs].all(axis=1)]], neighbours)
    untested = neighbours | mated | {(number, number) for number in range(count)}
    parts = tuple(_part(mesh, number, labels == number) for number in range(labels.max() + 1))
    faces = np.unique(mesh.faces[in_joint[: len(mesh.faces)]])
    return Regions(parts, frozenset(untested), count, len(faces))


def _of_faces(owners: Indices, rows: Flags) -> Flags:
    """All triangles of the faces that have one of the triangles flagged in `rows`."""
    chosen = np.zeros(int(owners.max(initial=-1)) + 1, bool)
    chosen[owners[rows]] = True
    flags: Flags = chosen[owners]
    return flags


def _lies_between(skin: Skin, joint: Joint, pairs: Indices) -> Flags:
    """Flags the pairs of triangles, (k,), one of which follows a joint, and the other does not."""
    follows = skin.share(joint.bones)[skin.corners[pairs]].mean(axis=2) >= 0.5
    flags: Flags = follows[:, 0] != follows[:, 1]
    return flags


def _mated(pairs: Indices, neighbours: set[tuple[int, int]]) -> set[tuple[int, int]]:
    """Pairs of parts, (k, 2), that cut each other in a joint, and each with the neighbours of the other."""
    cutting = {(min(pair), max(pair)) for pair in np.unique(pairs, axis=0).tolist() if pair[0] != pair[1]}
    beside: dict[int, set[int]] = {}
    for a, b in neighbours:
        beside.setdefault(a, set()).add(b)
        beside.setdefault(b, set()).add(a)
    found = set(cutting)
    for a, b in cutting:
        found |= {(min(a, each), max(a, each)) for each in beside.get(b, ())}
        found |= {(min(b, each), max(b, each)) for each in beside.get(a, ())}
    return found


def _region(skin: Skin, joint: Joint, radii: float, edges: Indices, mating: Indices) -> Flags:
    """The vertices around a joint, (n,): connected to those that it bends, and near it.

    mating: pairs of triangles, (k, 2), that cut each other at the start, and that the joint turns against each other.
    The pieces of a jointed machine have no others.
    """
    share = skin.share(joint.bones)
    bent = (share > BLENDED[0]) & (share < BLENDED[1])
    crossing = (share[edges] < 0.5).any(axis=1) & (share[edges] >= 0.5).any(axis=1)
    bent[edges[crossing]] = True
    bent[skin.corners[mating]] = True
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
