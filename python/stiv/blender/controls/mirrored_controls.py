# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrored editing of a mesh in Edit Mode: vertices follow those at their mirror images, as in Blender."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from mathutils.kdtree import KDTree
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Writer
from stiv.blender.controls.joined_seams import copy_to_seams, first_copies, selection_weights
from stiv.blender.controls.points import PointGoal
from stiv.blender.controls.subdivision import is_linear
from stiv.blender.scene.arrays import Flags, Floats, Indices, invert, transform_points
from stiv.blender.scene.evaluated_scene import VisibleMesh

DISTANCE = 2e-5  # local units within which Blender finds a mirror image
Signs = NDArray[np.int8]


@dataclass(frozen=True)
class MirroredWriter:
    """Writes all controls from those that are left of each mirrored group."""

    writer: Writer
    images: stiv.Deformation

    def write(self, controls: Floats) -> None:
        """Write world positions of the remaining controls, (k, 3), and their images."""
        self.writer.write(self.images.surface(controls))

    def restore(self) -> None:
        """Write the original positions."""
        self.writer.restore()


def mirror_controls(control_set: ControlSet, meshes: Sequence[VisibleMesh]) -> ControlSet:
    """The control set with one control for each group of vertices that Blender's mirror options connect.

    Unchanged outside Edit Mode, and without these options. Raises InputError for Topology Mirror.
    """
    ob = bpy.data.objects[control_set.names[0]]
    if control_set.role != "cage" or ob.mode != "EDIT":
        return control_set
    mesh, rule, frame = ob.data, control_set.rule, control_set.frame
    axes = np.array([mesh.use_mirror_x, mesh.use_mirror_y, mesh.use_mirror_z])
    if not axes.any():
        return control_set
    if mesh.use_mirror_topology:
        raise InputError(f"{ob.name}: Topology Mirror is not supported; turn it off")
    assert isinstance(rule, PointGoal) and frame is not None
    local = transform_points(invert(frame), control_set.controls)
    leaders, signs = _find_leaders(local, rule.selected, axes)
    if (signs == 1).all():
        return control_set
    kept = np.unique(leaders)
    images = _images(control_set.controls, leaders, kept, signs, frame)
    return replace(
        control_set,
        deformation=_composed(control_set, images, meshes),
        controls=control_set.controls[kept],
        weights=control_set.weights[kept],
        max_weights=control_set.max_weights[kept],
        rule=_rule_of(rule, leaders, kept),
        writer=MirroredWriter(control_set.writer, images),
        weight_axes=None if control_set.weight_axes is None else control_set.weight_axes[kept],
        kept=kept,
    )


def _composed(control_set: ControlSet, images: stiv.Deformation, meshes: Sequence[VisibleMesh]) -> stiv.Deformation:
    if control_set.observed is None:
        surface = control_set.deformation
        return stiv.compose(surface, images) if is_linear(surface) else images  # the identity has no weights
    seams = control_set.control_seams
    vertices = images if seams is None else copy_to_seams(images, seams)
    whole = control_set.observed.deformation_of(vertices)
    if not control_set.seams:
        return whole
    rows = first_copies(control_set.seams, [len(meshes[index].local) for index in control_set.surfaces])
    return stiv.compose(selection_weights(rows, whole.vertex_count), whole)


def _find_leaders(local: Floats, selected: Flags, axes: Flags) -> tuple[Indices, Signs]:
    """The control that each one follows, (m,), and the sign of its image along each axis, (m, 3); 0 on a plane.

    Vertices on the side with most of the selection lead, and selected ones before others.
    """
    sides = np.where(axes & (np.abs(local) > DISTANCE), np.sign(local), 0).astype(np.int8)
    side = np.where(sides[selected].sum(axis=0) < 0, -1, 1)
    rank = (sides == -side).sum(axis=1) + 4 * ~selected
    folded = np.where(axes, np.abs(local), local)
    leaders = np.arange(len(local), dtype=np.int32)
    for group in _groups(folded):
        members = np.array(group)
        if len(np.unique(sides[members], axis=0)) == len(members):  # otherwise images are ambiguous
            leaders[members] = members[np.argmin(rank[members])]
    signs = np.where(axes, sides * sides[leaders], 1).astype(np.int8)
    return leaders, signs


def _groups(points: Floats) -> list[list[int]]:
    """Numbers of points, (m, 3), that are close together, for each place with several."""
    tree = KDTree(len(points))
    for number, point in enumerate(points.tolist()):
        tree.insert(point, number)
    tree.balance()
    found, taken = [], np.zeros(len(points), np.bool_)
    for number, point in enumerate(points.tolist()):
        if not taken[number]:
            group = [other for _, other, _ in tree.find_range(point, DISTANCE) if not taken[other]]
            taken[group] = True
            found += [group] if len(group) > 1 else []
    return found


def _images(controls: Floats, leaders: Indices, kept: Indices, signs: Signs, frame: Floats) -> stiv.Deformation:
    """Deformation from the remaining controls to all of them, which start where they are, in world space."""
    linear = frame[:3, :3]
    flips = np.einsum("ij,nj,jk->nik", linear, signs.astype(np.float64), invert(linear))
    flips[(signs == 1).all(axis=1)] = np.eye(3)
    offsets = controls - np.einsum("nij,nj->ni", flips, controls[leaders])
    return _anchored(len(kept), np.searchsorted(kept, leaders).astype(np.int32), flips, offsets)


def _anchored(count: int, anchors: Indices, frames: Floats, offsets: Floats) -> stiv.Deformation:
    """Deformation q_i = frame_i p_anchor(i) + offset_i of `count` controls."""

    def evaluate(controls: Floats) -> Floats:
        images: Floats = np.einsum("nij,nj->ni", frames, controls[anchors]) + offsets
        return images

    rows = np.arange(len(anchors) + 1, dtype=np.int32)
    return stiv.observed(evaluate, (rows, anchors, frames, (len(anchors), count)))


def _rule_of(rule: PointGoal, leaders: Indices, kept: Indices) -> PointGoal:
    edges = None
    if rule.edges is not None:
        edges = np.searchsorted(kept, leaders)[rule.edges].astype(np.int32)
        edges = edges[edges[:, 0] != edges[:, 1]]
    pinned = None if rule.pinned is None else replace(rule.pinned, points=rule.pinned.points[kept])
    free = None if rule.free is None else rule.free[kept]
    return PointGoal(rule.selected[kept], rule.start[kept], edges, rule.frame, free, pinned)
