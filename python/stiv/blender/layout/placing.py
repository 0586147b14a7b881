# SPDX-License-Identifier: GPL-3.0-or-later
"""Spreads copies of an object on a surface, without contact between them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import mathutils
import numpy as np

from stiv import InputError
from stiv.blender.controls.object_transform import check_axes
from stiv.blender.controls.rotations import rotation_matrix, rotation_vector
from stiv.blender.layout.containment import is_outside
from stiv.blender.layout.layout_edit import LayoutEdit
from stiv.blender.layout.layout_task import LayoutReport, LayoutTask, Watch, run
from stiv.blender.layout.resting import fall
from stiv.blender.layout.rigid_contacts import is_clear
from stiv.blender.layout.rigid_scene import RigidScene
from stiv.blender.scene.arrays import Floats, as_matrix
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import check_scene
from stiv.task import Steps

TRIES = 24  # places for each copy
HIGHEST = 0.15  # of its size, above the point where a copy should rest; higher, it lies on something else
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class PlaceSettings:
    """How `place` works.

    Attributes:
        edit: the minimum distances, roles and guard; its time_budget limits the whole call.
        surface: name of the object to place on; "": the other selected objects.
        count: number of copies.
        seed: of the random places.
        align: the local Z axis of copies follows the normal of the surface; otherwise it keeps its direction.
        scale_variation: in [0, 1): each copy is scaled by a random factor between 1 - this and 1 + this.
        rotation_variation: radians; each copy turns about its normal by a random angle up to this, either way.
        linked: copies share the data of the object.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    surface: str = ""
    count: int = 10
    seed: int = 0
    align: bool = True
    scale_variation: float = 0.0
    rotation_variation: float = np.pi
    linked: bool = True

    def __post_init__(self) -> None:
        """Refuse values out of range."""
        if self.count < 1:
            raise InputError(f"count: {self.count} must be at least 1")
        if not 0 <= self.scale_variation < 1:
            raise InputError(f"scale_variation: {self.scale_variation!r} must be at least 0 and below 1")


class Place(LayoutTask):
    """Places copies of the active object on the other selected objects."""

    def __init__(self, context: bpy.types.Context, settings: PlaceSettings) -> None:
        """Read the scene. Raises InputError, also without a surface to place on."""
        super().__init__(settings.edit.time_budget)
        source = context.view_layer.objects.active
        if source is None:
            raise InputError("no active object; make the object to copy active")
        names = {settings.surface} if settings.surface else {ob.name for ob in context.selected_objects}
        self._context, self._settings, self._source = context, settings, source.name
        check_axes(source.name, as_matrix(source.matrix_world))  # copies have no parent, and so no shear
        self._edit = LayoutEdit(context, settings.edit, [source])
        self._corners = _surface_corners(self._edit, names - {source.name})
        self._axis = as_matrix(source.matrix_world)[:3, 2]
        self._axis /= np.linalg.norm(self._axis)
        self._transforms: list[Floats] = []
        self._created: list[bpy.types.Object] = []

    def _solve(self, watch: Watch) -> Steps[None]:
        count, rng = self._settings.count, np.random.default_rng(self._settings.seed)
        factors = 1 + self._settings.scale_variation * rng.uniform(-1, 1, count)
        scene = self._edit.scene.with_copies(0, factors)
        absent = set(range(1, count + 1))
        for number, copy in enumerate(sorted(absent)):
            yield from watch.at(self._source, number / count)
            scene.leave_out(list(absent - {copy}))
            if (yield from self._place(scene, copy, rng, watch)):
                self._transforms.append(_transform(self._edit.scene.pose(0), scene.pose(copy), factors[number]))
                absent.remove(copy)

    def _place(self, scene: RigidScene, copy: int, rng: np.random.Generator, watch: Watch) -> Steps[bool]:
        size = scene.size(copy)
        for _ in range(TRIES):
            yield from watch.check()
            point, normal = _random_point(self._corners, rng)
            up = normal if self._settings.align else UP
            spin = rng.uniform(-1, 1) * self._settings.rotation_variation
            if float(normal @ up) < 0.2:  # a wall or a ceiling
                continue
            self._stand(scene, copy, point, up, spin, size)
            if not is_clear(scene, copy) or (yield from fall(scene, copy, -up, 2 * size)) is None:
                continue
            height = float(((scene.positions_of(copy) - point) @ up).min())
            if not -HIGHEST * size < height < HIGHEST * size or not (yield from is_outside(scene, copy)):
                continue
            if is_clear(scene, copy):
                return True
        return False

    def _stand(self, scene: RigidScene, copy: int, point: Floats, up: Floats, spin: float, size: float) -> None:
        """Pose a copy upright above a point, higher by its size."""
        upright = _rotation_between(self._axis, up) if self._settings.align else np.eye(3)
        pose = self._edit.scene.pose(0)
        pose[1] = rotation_vector(rotation_matrix(spin * up) @ upright @ rotation_matrix(pose[1]))
        scene.set_pose(copy, pose)
        below = float((scene.positions_of(copy) @ up).min())
        middle = scene.box(copy).mean(axis=0)
        across = (point - middle) - float((point - middle) @ up) * up
        scene.shift(copy, across + (float(point @ up) - below + size) * up)

    def _write(self) -> LayoutReport:
        source = bpy.data.objects[self._source]
        pairs = _pairs_of(self._context, self._settings.edit)
        self._created = [
            _copy(source, transform @ as_matrix(source.matrix_world), self._settings.linked)
            for transform in self._transforms
        ]
        self._context.view_layer.update()
        self._remove_intersecting(pairs)
        names = tuple(ob.name for ob in self._created)
        status = "done" if names else "unchanged"
        return LayoutReport(status, names, asked=self._settings.count)

    def _remove_intersecting(self, before: set[frozenset[str]]) -> None:
        """Remove copies that intersect in Blender's evaluation, because their shape depends on their place."""
        new = _pairs_of(self._context, self._settings.edit) - before
        for ob in list(self._created):
            family = {ob.name, *(child.name for child in ob.children_recursive)}
            mine = {pair for pair in new if pair & family and not pair <= family}  # a copy may intersect itself
            if mine:
                new -= mine
                self._created.remove(ob)
                _remove(ob)
        self._context.view_layer.update()

    def restore(self) -> None:
        """Remove all copies."""
        for ob in self._created:
            _remove(ob)
        self._created = []


def _surface_corners(edit: LayoutEdit, names: set[str]) -> Floats:
    """Corners, (f, 3, 3), of the triangles of named objects."""
    meshes = [k for k, mesh in enumerate(edit.assembly.meshes) if mesh.owner.name in names and mesh.strands is None]
    flags = np.isin(edit.assembly.surface.triangles[:, 0], edit.assembly.vertices_of(meshes)) if meshes else False
    if not np.any(flags):
        raise InputError("no surface to place on; select it too, before the object to copy")
    return edit.assembly.positions[edit.assembly.surface.triangles[flags]]


def _random_point(corners: Floats, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """A point of a surface and its normal, (3,) each, uniform by area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.cumsum(np.linalg.norm(normals, axis=1))
    face = int(np.searchsorted(areas, rng.random() * areas[-1]))
    face = min(face, len(corners) - 1)
    u, v = rng.random(2)
    u, v = (1 - u, 1 - v) if u + v > 1 else (u, v)
    a, b, c = corners[face]
    return a + u * (b - a) + v * (c - a), normals[face] / max(float(np.linalg.norm(normals[face])), 1e-300)


def _rotation_between(first: Floats, second: Floats) -> Floats:
    """The smallest rotation, (3, 3), from one unit vector to another."""
    axis = np.cross(first, second)
    sine, cosine = float(np.linalg.norm(axis)), float(first @ second)
    if sine < 1e-12:
        axis, sine = np.cross(first, np.eye(3)[np.abs(first).argmin()]), 1e-300
    return rotation_matrix(axis / np.linalg.norm(axis) * np.arctan2(sine, cosine))


def _transform(start: Floats, pose: Floats, factor: float) -> Floats:
    """The map, (4, 4), from the object at its start to a scaled copy in its pose, about the center."""
    matrix = np.eye(4)
    matrix[:3, :3] = factor * rotation_matrix(pose[1]) @ rotation_matrix(start[1]).T
    matrix[:3, 3] = pose[0] - matrix[:3, :3] @ start[0]
    return matrix


def _copy(source: bpy.types.Object, world: Floats, linked: bool) -> bpy.types.Object:
    """A copy of an object and its children, with this world matrix and no animation."""
    copy = _copy_alone(source, linked)
    copy.parent = None
    copy.matrix_world = mathutils.Matrix(world.tolist())
    _copy_children(source, copy, linked)
    return copy


def _copy_children(source: bpy.types.Object, copy: bpy.types.Object, linked: bool) -> None:
    for child in source.children:
        inverse = child.matrix_parent_inverse.copy()
        other = _copy_alone(child, linked)
        other.parent, other.matrix_parent_inverse = copy, inverse
        _copy_children(child, other, linked)


def _copy_alone(source: bpy.types.Object, linked: bool) -> bpy.types.Object:
    copy = source.copy()
    if not linked and copy.data is not None:
        copy.data = copy.data.copy()
    copy.animation_data_clear()
    for collection in source.users_collection:
        collection.objects.link(copy)
    copy.select_set(False)
    return copy


def _remove(ob: bpy.types.Object) -> None:
    for each in (*ob.children_recursive, ob):
        bpy.data.objects.remove(each)


def _pairs_of(context: bpy.types.Context, settings: EditSettings) -> set[frozenset[str]]:
    """Names of the objects that intersect."""
    return {frozenset(both) for both in check_scene(context, settings).pairs.by_objects()}


def place(context: bpy.types.Context, settings: PlaceSettings | None = None, **execution: Any) -> LayoutReport:
    """Place copies of the active object on the other selected objects; the report names the copies.

    `cancel` and `progress` are those of stiv.EditSession. Raises InputError, with nothing changed.
    """
    return run(Place(context, settings or PlaceSettings()), **execution)
