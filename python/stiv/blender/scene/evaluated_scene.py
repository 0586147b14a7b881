# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that is visible, as Blender evaluates it, in world space."""

from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, transform_points
from stiv.blender.scene.evaluation_copies import Twins, open_twins
from stiv.blender.scene.evaluations import (
    EVALUATIONS,
    RENDER,
    SHOWN,
    VIEWPORT,
    Differences,
    find_differences,
    rendered_objects,
)
from stiv.blender.scene.mesh_reading import (
    evaluated_mesh,
    read_edges,
    read_loose_numbers,
    read_positions,
    read_triangles,
)
from stiv.blender.scene.near_faces import NearFaces, read_near_faces
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.strand_reading import (
    STRAND_TYPES,
    check_finite,
    hair_systems,
    helper_curves,
    read_particle_hair,
    read_strands,
    surface_of,
    why_no_particle_hair,
    why_no_strands,
)
from stiv.blender.scene.strands import Strands, cover

SURFACE_TYPES = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD"})


@dataclass(frozen=True)
class VisibleMesh:
    """One evaluated mesh, where it stands in the world.

    Attributes:
        owner: the object that shows it: for an instance, the object that makes the instance.
        source: name of the object whose data is shown; the owner's own name for what is not an instance.
        local: positions in its own frame as stored, (n, 3): single precision, of strands double.
        matrix: frame to world, (4, 4).
        triangles: Blender's triangulation, (f, 3).
        faces: the face each triangle belongs to, (f,).
        loose_edges: edges of no face, (l, 2).
        loose_numbers: their numbers among all edges, (l,).
        near: which part of Blender's mesh this is; None: all of it.
        read_in: the evaluation that it was read from.
        exists_in: the evaluations that show exactly this mesh.
        strands: of curves and hair, the strand that each vertex belongs to, (n,); None for a mesh of Blender's.
        rooted_in: names of the objects that strands grow from or hang on, and are not tested against.
    """

    owner: ObjectReference
    source: str
    local: NDArray[Any]
    matrix: Floats
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    near: NearFaces | None = None
    read_in: str = SHOWN
    exists_in: frozenset[str] = frozenset(EVALUATIONS)
    strands: Indices | None = None
    rooted_in: frozenset[str] = frozenset()

    @property
    def is_instance(self) -> bool:
        """Shown through another object."""
        return self.source != self.owner.name

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        return transform_points(self.matrix, self.local)

    def vertex_number(self, vertex: int) -> int:
        """Number of a vertex in Blender's mesh."""
        return vertex if self.near is None else int(self.near.vertices[vertex])

    @property
    def size(self) -> int:
        """Number of vertices of Blender's mesh."""
        return len(self.local) if self.near is None else self.near.size


@dataclass(frozen=True)
class EvaluatedScene:
    """All visible meshes, and how many objects with a surface are hidden or excluded."""

    meshes: tuple[VisibleMesh, ...]
    hidden: int


@dataclass(frozen=True)
class Placed:
    """Positions alone of one visible mesh, for reading back."""

    owner: ObjectReference
    local: Singles
    matrix: Floats

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        return transform_points(self.matrix, self.local)

    def limited_to(self, vertices: Indices) -> "Placed":
        """Some of the vertices, (k,)."""
        return Placed(self.owner, self.local[vertices], self.matrix)


class Opened:
    """Evaluations of a scene that can be read, for as long as `open_evaluations` lasts."""

    def __init__(
        self, context: bpy.types.Context, wanted: Collection[str] = (SHOWN,), differences: Differences | None = None
    ) -> None:
        """Use `open_evaluations`, but for what is shown now alone."""
        self._context = context
        self._wanted = frozenset(wanted)
        self._differences = differences or Differences()
        self.twins: dict[str, Twins] = {}

    @property
    def read_in(self) -> tuple[str, ...]:
        """The evaluations that have to be read."""
        return (SHOWN, *self.twins)

    def exists_in(self, read_in: str, number: int) -> frozenset[str]:
        """The wanted evaluations that show what this one shows of an object, by its session number."""
        different, found = self._differences, {read_in}
        if read_in == SHOWN and number not in different.viewport:
            found.add(VIEWPORT)
        if VIEWPORT in found and number in different.rendered and number not in different.render:
            found.add(RENDER)
        return frozenset(found & self._wanted)

    def hair_exists_in(self, number: int) -> frozenset[str]:
        """The wanted evaluations in which an object has particle hair, which is read as the viewport shows it."""
        found = {SHOWN, VIEWPORT} | ({RENDER} if number in self._differences.rendered else set())
        return frozenset(found & self._wanted)

    def instances(
        self, read_in: str, is_wanted: Callable[[bpy.types.Object], bool], types: Collection[str] = ("MESH",)
    ) -> Iterator[tuple[bpy.types.DepsgraphObjectInstance, bpy.types.Object, bpy.types.Object]]:
        """Each mesh, or what is of other types, that an evaluation shows, with its owner and whose data it is."""
        twins = self.twins.get(read_in)
        for instance in self.depsgraph(read_in).object_instances:
            if instance.object.type not in types or not (instance.show_self or instance.is_instance):
                continue
            owner = instance.parent.original if instance.is_instance else instance.object.original
            source = instance.instance_object.original if instance.is_instance else owner
            if twins is not None:
                owner, source = twins.owner(owner), twins.owner(source)
            if is_wanted(owner):
                yield instance, owner, source

    def depsgraph(self, read_in: str) -> bpy.types.Depsgraph:
        """What evaluates it."""
        return self.twins[read_in].depsgraph if read_in in self.twins else self._context.evaluated_depsgraph_get()

    def evaluated(self, read_in: str, owner: ObjectReference) -> bpy.types.Object:
        """An object as evaluated."""
        if read_in in self.twins:
            return self.twins[read_in].evaluated(owner)
        return owner.find().evaluated_get(self._context.evaluated_depsgraph_get())


@contextmanager
def open_evaluations(context: bpy.types.Context, wanted: Collection[str]) -> Iterator[Opened]:
    """Make evaluations readable: the one shown now, and copies of the objects that differ in another one."""
    differences = find_differences(context, wanted)
    opened = Opened(context, wanted, differences)
    with ExitStack() as stack:
        for evaluation, numbers in ((VIEWPORT, differences.viewport), (RENDER, differences.render)):
            objects = [ob for ob in bpy.data.objects if ob.session_uid in numbers] if evaluation in wanted else []
            if objects:
                shown = _rendered(differences) if evaluation == RENDER else (lambda ob: is_visible(context, ob))
                opened.twins[evaluation] = stack.enter_context(open_twins(context, evaluation, objects, shown))
        yield opened


def _rendered(differences: Differences) -> Callable[[bpy.types.Object], bool]:
    return lambda ob: ob.session_uid in differences.rendered


def read_scene(
    context: bpy.types.Context,
    accept: Callable[[str], bool] = lambda name: True,
    box_of: Callable[[str], tuple[Floats, Floats] | None] = lambda name: None,
    evaluations: Collection[str] = (SHOWN,),
    strands: bool = False,
) -> EvaluatedScene:
    """Read every mesh whose owner's name is accepted; with a box of the world, (3,) and (3,), what touches it.

    evaluations: which ones to read; a mesh that several of them show comes once, and says in which it exists.
    Curves, text, surfaces, metaballs and instances come as the meshes they show. Local view is respected where the
    context has a 3D view, but not by the render. Raises InputError naming object and vertex when a coordinate is not
    finite. strands: also read curves without surface, hair curves and particle hair, after all meshes.
    """
    shown: dict[int, bool] = {}

    def is_shown(owner: bpy.types.Object) -> bool:
        if owner.session_uid not in shown:
            shown[owner.session_uid] = is_visible(context, owner)
        return shown[owner.session_uid]

    meshes: list[VisibleMesh] = []
    found: list[VisibleMesh] = []
    with open_evaluations(context, evaluations) as opened:
        for read_in in opened.read_in:

            def is_wanted(owner: bpy.types.Object, read_in: str = read_in) -> bool:
                exists = opened.exists_in(read_in, owner.session_uid)
                return bool(exists) and accept(owner.name) and (read_in == RENDER or is_shown(owner))

            for instance, owner, source in opened.instances(read_in, is_wanted):
                exists_in = opened.exists_in(read_in, owner.session_uid)
                meshes.append(_read_mesh(instance, owner, source, box_of(owner.name), read_in, exists_in))
            if strands:
                found += _read_strands(context, opened, read_in, is_wanted)
        if strands:
            found += _read_particle_hair(context, opened, lambda owner: accept(owner.name) and is_shown(owner))
    return EvaluatedScene((*meshes, *found), _left_out_count(context, evaluations))


def read_placed(owners: frozenset[int], opened: Opened, read_in: str = SHOWN) -> list[Placed]:
    """Positions of what these owners (session numbers) show, in the order of `read_scene`; much cheaper than all."""
    placed = []
    for instance, owner, _ in opened.instances(read_in, lambda ob: ob.session_uid in owners):
        with evaluated_mesh(instance.object) as mesh:
            matrix = as_matrix(instance.matrix_world)
            placed.append(Placed(ObjectReference.of(owner), read_positions(mesh), matrix))
    return placed


def is_visible(context: bpy.types.Context, ob: bpy.types.Object) -> bool:
    """Is the object visible in the context's view layer and, where there is one, local view?"""
    return bool(ob.visible_get(view_layer=context.view_layer, viewport=_local_view(context)))


def _local_view(context: bpy.types.Context) -> bpy.types.SpaceView3D | None:
    space = context.space_data
    return space if isinstance(space, bpy.types.SpaceView3D) and space.local_view is not None else None


def _read_mesh(
    instance: bpy.types.DepsgraphObjectInstance,
    shown_by: bpy.types.Object,
    data_of: bpy.types.Object,
    box: tuple[Floats, Floats] | None,
    read_in: str,
    exists_in: frozenset[str],
) -> VisibleMesh:
    owner, source, near = ObjectReference.of(shown_by), data_of.name, None
    matrix = as_matrix(instance.matrix_world)
    with evaluated_mesh(instance.object) as mesh:
        if box is not None:
            near = read_near_faces(mesh, matrix, *box)
            data = (near.local, matrix, near.triangles, near.faces, near.loose_edges, near.loose_numbers)
        else:
            triangles, faces = read_triangles(mesh)
            loose = read_loose_numbers(mesh)
            edges = read_edges(mesh)[loose] if len(loose) else np.empty((0, 2), np.int32)
            data = (read_positions(mesh), matrix, triangles, faces, edges, loose)
    found = VisibleMesh(owner, source, *data, near, read_in, exists_in)
    _check_finite(found)
    return found


def _read_strands(
    context: bpy.types.Context, opened: Opened, read_in: str, is_wanted: Callable[[bpy.types.Object], bool]
) -> Iterator[VisibleMesh]:
    """Curves without surface and hair curves of an evaluation that can be obstacles."""
    helpers = helper_curves(context)
    for instance, owner, source in opened.instances(read_in, is_wanted, STRAND_TYPES):
        if not why_no_strands(instance.object, source, helpers):
            exists_in = opened.exists_in(read_in, owner.session_uid)
            yield from _covered(read_strands(instance), owner, source, read_in, exists_in)


def _read_particle_hair(
    context: bpy.types.Context, opened: Opened, is_wanted: Callable[[bpy.types.Object], bool]
) -> Iterator[VisibleMesh]:
    graph = context.evaluated_depsgraph_get()
    for ob in context.view_layer.objects:
        exists_in = opened.hair_exists_in(ob.session_uid)
        if exists_in and hair_systems(ob) and is_wanted(ob):
            evaluated = ob.evaluated_get(graph)
            if not why_no_particle_hair(evaluated):
                yield from _covered(read_particle_hair(evaluated), ob, ob, SHOWN, exists_in)


def _covered(
    strands: Strands, owner: bpy.types.Object, source: bpy.types.Object, read_in: str, exists_in: frozenset[str]
) -> Iterator[VisibleMesh]:
    """The surface of strands as a mesh in world space; none where there is no segment."""
    check_finite(strands, owner.name)
    surface = cover(strands)
    if len(surface.positions):
        faces = surface.numbers[surface.triangles[:, 0]]
        numbers = surface.numbers[surface.edges[:, 0]]
        yield VisibleMesh(
            ObjectReference.of(owner), source.name, surface.positions, np.eye(4), surface.triangles, faces,
            surface.edges, numbers, None, read_in, exists_in, surface.numbers, _roots(owner),
        )  # fmt: skip


def _roots(owner: bpy.types.Object) -> frozenset[str]:
    """The object itself, its parents, the surface that hair curves are attached to, and what hangs on a curve."""
    found, waiting = set(), [owner]
    while waiting:
        ob = waiting.pop()
        found.add(ob.name)
        above = (ob.parent, surface_of(ob))
        waiting += [each for each in above if each is not None and each.name not in found]
    if owner.type == "CURVE":
        found |= {child.name for child in owner.children_recursive}
    return frozenset(found)


def _check_finite(mesh: VisibleMesh) -> None:
    if not np.isfinite(mesh.matrix).all():
        raise InputError(f'object "{mesh.owner.name}": its placement is not finite; clear its location and scale')
    finite = np.isfinite(mesh.local).all(axis=1)
    if not finite.all():
        vertex = mesh.vertex_number(int(np.argmin(finite)))
        raise InputError(f'object "{mesh.owner.name}", vertex {vertex}: coordinate is not finite')


def _left_out_count(context: bpy.types.Context, evaluations: Collection[str]) -> int:
    """Objects with a surface that none of the evaluations shows."""
    shown: set[int] = set()
    if SHOWN in evaluations or VIEWPORT in evaluations:
        shown |= {ob.session_uid for ob in context.view_layer.objects if is_visible(context, ob)}
    if RENDER in evaluations:
        shown |= rendered_objects(context.view_layer)
    return sum(ob.type in SURFACE_TYPES and ob.session_uid not in shown for ob in context.scene.objects)
