# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps vertices where modifiers need them: on the plane of a Mirror modifier, and where a Weld modifier merges them.

Apart from their images, or from each other, they would change the topology.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from stiv.blender.scene.arrays import Flags, Floats, Indices, apply_linear, as_matrix, invert, to_local

ON_PLANE = 1e-6  # distance of a vertex from its image, in sizes of the mesh, without merging


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """Vertices, (m,) flags, that do not move along a normal, (3,), in local space.

    Attributes:
        offset: of the plane: it consists of the points x with normal * x = offset.
        threshold: distance from the plane up to which a vertex is merged with its image; -1: none is.
    """

    vertices: Flags
    normal: Floats
    offset: float = 0.0
    threshold: float = -1.0

    def keeps_apart(self, local: Floats) -> bool:
        """Are the same vertices merged with their images at local positions, (m, 3), as at the start?"""
        if self.threshold < 0:
            return True
        distances = np.abs(local @ self.normal - self.offset)
        return bool((distances[~self.vertices] > self.threshold).all())


@dataclass(frozen=True, eq=False)
class HeldVertices:
    """Restrictions of a mesh's vertices.

    Attributes:
        planes: the planes of all Mirror modifiers.
        leaders: the vertex with which each one moves, (m,); None if each moves alone.
    """

    planes: tuple[MirrorPlane, ...]
    leaders: Indices | None

    def hold(self, positions: Floats, start: Floats, frame: Floats) -> Floats:
        """World positions, (m, 3), with the restrictions of their motion since the start, (m, 3).

        frame: of the object, (4, 4).
        """
        if not self.planes and self.leaders is None:
            return positions
        linear = frame[:3, :3]
        motion = apply_linear(invert(linear), positions - start)
        held = start + apply_linear(linear, self._limited(motion))
        return np.asarray(np.where(self._restricted[:, None], held, positions), np.float64)

    def _limited(self, motion: Floats) -> Floats:
        """A local motion, (m, 3), with the restrictions."""
        limited = motion if self.leaders is None else motion[self.leaders]
        for plane in self.planes:
            across = limited[plane.vertices] @ plane.normal
            limited[plane.vertices] -= across[:, None] * plane.normal
        return limited

    def keeps_apart(self, positions: Floats, start: Floats, frame: Floats) -> bool:
        """Do Mirror modifiers merge the same vertices at world positions, (m, 3), as at the start?"""
        if all(plane.threshold < 0 for plane in self.planes):
            return True
        local = to_local(frame, self.hold(positions, start, frame))
        return all(plane.keeps_apart(local) for plane in self.planes)

    @property
    def _restricted(self) -> Flags:
        flags = [plane.vertices for plane in self.planes]
        if self.leaders is not None:
            flags.append(self.leaders != np.arange(len(self.leaders)))
        return np.asarray(np.any(flags, axis=0))


def find_held_vertices(users: Sequence[bpy.types.Object], local: Floats) -> HeldVertices:
    """The restrictions of a mesh at local positions, (m, 3), by the modifiers of all objects that show it."""
    active = [
        (ob, modifier) for ob in dict.fromkeys(users) for modifier in ob.modifiers
        if modifier.show_viewport or modifier.show_render
    ]  # fmt: skip
    mirrors = [(ob, each) for ob, each in active if isinstance(each, bpy.types.MirrorModifier)]
    planes = [_plane(ob, each, axis, local) for ob, each in mirrors for axis in range(3) if each.use_axis[axis]]
    welds = [each for _, each in active if isinstance(each, bpy.types.WeldModifier)]
    leaders = _leaders(local, max((each.merge_threshold for each in welds), default=-1.0))
    return HeldVertices(tuple(plane for plane in planes if plane.vertices.any() or plane.threshold >= 0), leaders)


def _plane(ob: bpy.types.Object, modifier: bpy.types.MirrorModifier, axis: int, local: Floats) -> MirrorPlane:
    to_mirror = np.eye(4)
    if modifier.mirror_object is not None:
        mirror = invert(as_matrix(modifier.mirror_object.matrix_world))
        to_mirror = mirror @ as_matrix(ob.matrix_world)
    across = local @ to_mirror[axis, :3] + to_mirror[axis, 3]
    length = float(np.linalg.norm(to_mirror[axis, :3]))
    scale = 2 * length * float(np.linalg.norm(invert(to_mirror[:3, :3])[:, axis]))  # from distances to merging
    size = float(np.ptp(local, axis=0).max(initial=0.0))
    merges = modifier.use_mirror_merge
    threshold = (modifier.merge_threshold if merges else ON_PLANE * size) / scale
    near = np.abs(across) / length <= threshold
    return MirrorPlane(near, to_mirror[axis, :3] / length, -to_mirror[axis, 3] / length, threshold if merges else -1.0)


def _leaders(local: Floats, distance: float) -> Indices | None:
    """For each vertex the first one within a distance; None if all are apart."""
    if distance < 0:
        return None
    tree = KDTree(len(local))
    for number, point in enumerate(local.tolist()):
        tree.insert(point, number)
    tree.balance()
    leaders = np.array(
        [min(found[1] for found in tree.find_range(point, distance)) for point in local.tolist()], np.int32
    )
    leaders = leaders[leaders]
    return None if (leaders == np.arange(len(local))).all() else leaders
