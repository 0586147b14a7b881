# SPDX-License-Identifier: GPL-3.0-or-later
"""A hidden copy of a mesh object, evaluated with any vertex positions by Blender itself."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol, TypeVar, cast

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Indices, Singles, read_collection
from stiv.blender.scene.dependencies import add_dependents, shape_dependencies
from stiv.blender.scene.evaluation_copies import EvaluationCopies, remove_copies
from stiv.blender.scene.evaluations import SHOWN, signature
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_corners, read_positions
from stiv.blender.scene.references import ObjectReference, SceneChangedError

ATTRIBUTE = "stiv_rest"


@dataclass(frozen=True, eq=False)
class EvaluatedStack:
    """Blender's evaluation of a twin: local positions, (n, 3), corners of the faces and the first corner of each."""

    positions: Singles
    corners: Indices
    starts: Indices

    def has_topology_of(self, other: EvaluatedStack) -> bool:
        """Do both have the same vertices and faces?"""
        return (
            len(self.positions) == len(other.positions)
            and np.array_equal(self.corners, other.corners)
            and np.array_equal(self.starts, other.starts)
        )

    def corresponds_to(self, other: EvaluatedStack) -> bool:
        """Do both have the same vertices, and the same faces up to the diagonals of triangulated ones?"""
        if len(self.positions) != len(other.positions) or not np.array_equal(self.starts, other.starts):
            return False
        sizes = np.diff(self.starts)
        changed = np.unique(np.repeat(np.arange(len(sizes)), sizes)[self.corners != other.corners])
        if len(changed) == 0:
            return True
        lost = np.setdiff1d(self._triangle_edges(changed), other._triangle_edges(changed))
        return bool((sizes[changed] == 3).all()) and len(lost) < len(changed)

    def _triangle_edges(self, faces: Indices) -> NDArray[np.int64]:
        """A number for each edge of triangular faces."""
        rows = self.corners[self.starts[faces][:, None] + np.arange(3)].astype(np.int64)
        ends = np.stack([rows, np.roll(rows, -1, axis=1)])
        return np.unique(ends.min(axis=0) * len(self.positions) + ends.max(axis=0))

    def equals(self, other: EvaluatedStack) -> bool:
        """Do both agree to the last bit?"""
        return self.has_topology_of(other) and np.array_equal(self.positions, other.positions)


class StackTwin:
    """A copy of a mesh object with a mesh of its own, alone in a scene of its own."""

    def __init__(self, ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> None:
        """Copy the object as an evaluation of the scene shows it. Use `open_twin`, or call `remove` at the end."""
        reference = ObjectReference.of(ob)
        self.copies = EvaluationCopies(scene, evaluation, own_data=[ob])
        try:
            self.copies.fill([ob, *different_objects(ob, scene, evaluation)], lambda other: other == ob)
        except BaseException:
            self.copies.remove()
            raise
        self.ob = self.copies.copy_of(reference)
        _remove_keys(self.ob)  # positions are those that the keys show

    def remove(self) -> None:
        """Remove the copy and its scene."""
        self.copies.remove()

    def show_modifiers(self, names: Collection[str], show: bool) -> None:
        """Switch modifiers on or off."""
        for name in names:
            self.ob.modifiers[name].show_viewport = show

    def evaluate(self, local: Singles) -> EvaluatedStack:
        """Blender's evaluation at local positions of the vertices, (m, 3)."""
        self.write(local)
        with self.evaluated() as mesh:
            return EvaluatedStack(read_positions(mesh), *read_corners(mesh))

    def write(self, local: Singles) -> None:
        """Write local positions, (m, 3). Writing an attribute instead would leave normals and bounds unchanged.

        Raises SceneChangedError if the mesh has another number of vertices.
        """
        mesh = self.ob.data
        if len(mesh.vertices) != len(local):
            raise SceneChangedError(f"{self.copies.owner(self.ob).name} changed its number of vertices")
        mesh.vertices.foreach_set("co", np.ascontiguousarray(local, np.float32).ravel())
        mesh.update()

    def carried(self, values: Singles) -> Singles | None:
        """Values of the vertices, (m, 3), at the evaluated vertices, (n, 3); None if the modifiers drop attributes."""
        mesh = self.ob.data
        attribute = mesh.attributes.new(ATTRIBUTE, "FLOAT_VECTOR", "POINT")
        name = attribute.name
        attribute.data.foreach_set("vector", np.ascontiguousarray(values, np.float32).ravel())
        mesh.update()
        with self.evaluated() as shown:
            found = shown.attributes.get(name)
            has_points = found is not None and (found.domain, found.data_type) == ("POINT", "FLOAT_VECTOR")
            result = read_collection(found.data, "vector", 3, np.float32) if has_points else None
        mesh.attributes.remove(mesh.attributes[name])
        mesh.update()
        return result if result is not None and result.any() else None

    @contextmanager
    def evaluated(self) -> Iterator[bpy.types.Mesh]:
        """The evaluated mesh, valid inside the `with` statement."""
        graph = self.copies.depsgraph
        graph.update()
        with evaluated_mesh(self.ob.evaluated_get(graph)) as mesh:
            yield mesh


class Twin(Protocol):
    """A hidden copy that is removed at the end."""

    @property
    def copies(self) -> EvaluationCopies:
        """The copy with its scene."""


T = TypeVar("T", bound=Twin)
_kept: dict[object, Twin] = {}
_holders = 0


@contextmanager
def kept_twins() -> Iterator[None]:
    """Keep the twins of `kept_twin`; the outermost `with` statement removes them.

    They must not be there when Blender stores an undo step or a file.
    """
    global _holders
    _holders += 1
    try:
        yield
    finally:
        _holders -= 1
        if _holders == 0:
            _remove_kept()


def kept_twin(owner: object, make: Callable[[], T]) -> T:
    """The twin of an owner, made now unless it is kept. Only inside `kept_twins`."""
    if owner not in _kept:
        _kept[owner] = make()
    return cast(T, _kept[owner])


def _remove_kept() -> None:
    copies = [twin.copies for twin in _kept.values()]
    _kept.clear()
    remove_copies(copies)


def _remove_keys(ob: bpy.types.Object) -> None:
    """Remove the shape keys of a copy. Blender counts a user too many, and would save them with the file."""
    if ob.data.shape_keys is not None:
        number = ob.data.shape_keys.session_uid
        ob.shape_key_clear()
        bpy.data.batch_remove([each for each in bpy.data.shape_keys if each.session_uid == number])


@contextmanager
def open_twin(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> Iterator[StackTwin]:
    """A twin that is removed at the end of the `with` statement."""
    twin = StackTwin(ob, scene, evaluation)
    try:
        yield twin
    finally:
        twin.remove()


def different_objects(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> list[bpy.types.Object]:
    """Objects to which the object refers, directly or indirectly, and which this evaluation shows differently."""
    if evaluation == SHOWN:
        return []
    used_by: dict[bpy.types.Object, set[bpy.types.Object]] = {}
    waiting = [ob]
    while waiting:
        user = waiting.pop()
        if user not in used_by:
            used_by[user] = set(shape_dependencies(user))
            waiting += used_by[user]
    different = {
        each for each in used_by
        if each.mode == "EDIT" or signature(each, scene, SHOWN) != signature(each, scene, evaluation)
    }  # fmt: skip
    numbers = {user.session_uid: {used.session_uid for used in found} for user, found in used_by.items()}
    chosen = add_dependents({each.session_uid for each in different}, numbers)
    return [each for each in used_by if each.session_uid in chosen and each != ob]
