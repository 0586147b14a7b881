# SPDX-License-Identifier: GPL-3.0-or-later
"""What an edit begins with: who takes part, as the scene is when it is read."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.control_reading import make_parts
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.movers import Mover
from stiv.blender.edit.sessions import mobilities, seams_of, stacked
from stiv.blender.scene.arrays import Floats, Indices, as_matrix
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.culling import Reach, tied
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.guarded_evaluations import Guard, read_guarded_scene
from stiv.blender.scene.strand_reading import surface_of
from stiv.blender.settings import EditSettings


@dataclass(frozen=True)
class Beginning:
    """A scene that was read for an edit. Keeps no reference of Blender's that an undo step could spoil.

    Attributes:
        assembly: all surfaces.
        parts: what moves or gives way, in the order of the controls.
        settings: with the exclusions that still count.
        guard: the evaluations that are kept free of intersections.
        hidden: how many objects do not take part because they are hidden.
        dropped: which exclusions of intersections no longer count, empty if all do.
        digest: equal for edits that begin with the same controls, surfaces that move and placements.
        carried: names of the objects whose strands follow what moves, and are no obstacles.
    """

    assembly: Assembly
    parts: tuple[Part, ...]
    settings: EditSettings
    guard: Guard
    hidden: int
    dropped: str
    digest: str
    carried: frozenset[str]


def read_beginning(
    context: bpy.types.Context,
    settings: EditSettings,
    kind: str,
    movers: Sequence[Mover],
    adapt: Callable[[Part], Part],
    reach: Reach | None,
) -> Beginning:
    """Read the scene for an edit of this kind with these movers; changes nothing. Raises InputError.

    adapt: may change who responds in a part. reach: what does not touch it does not take part; None: all does.
    """
    left_out = frozenset() if reach is None else reach.left_out
    scene, guard = read_guarded_scene(
        context,
        settings,
        lambda name: settings.takes_part(name) and name not in left_out,
        lambda name: None if reach is None else reach.box_of(name),
        strands=True,
    )
    solid = [mesh for mesh in scene.meshes if mesh.strands is None]
    found, groups = make_parts(context, movers, solid, settings, kind)
    parts = tuple(adapt(part) for part in found)
    if not any(part.rule.moves for part in parts):
        raise InputError("nothing is selected that may move; select vertices, points or objects with a surface")
    moving = {mover.reference.name for mover in movers}.union(
        *(group.members for group in groups), (solid[index].owner.name for part in parts for index in part.surfaces)
    )
    still, carried = _still_strands(context, scene.meshes, moving)
    meshes = [*solid, *still]
    count = len(meshes)
    assembly = assemble(
        meshes, mobilities(count, parts), [group.members for group in groups], settings.ignored_pairs,
        seams_of(count, parts),
    )  # fmt: skip
    excluded, dropped = settings.excluded.current(solid)
    placements = [as_matrix(ob.matrix_world) for ob in context.view_layer.objects]
    points = assembly.positions[moving_vertices(assembly, parts)]
    digest = _digest(stacked([part.controls for part in parts]), points, *placements)
    chosen = replace(settings, excluded=excluded)
    return Beginning(assembly, parts, chosen, guard, scene.hidden, dropped, digest, carried)


def moving_vertices(assembly: Assembly, parts: Sequence[Part]) -> Indices:
    """The vertices of the surface that follow controls of the parts."""
    return np.concatenate([assembly.range_of(index) for part in parts for index in part.surfaces])


def _still_strands(
    context: bpy.types.Context, meshes: Sequence[VisibleMesh], moving: set[str]
) -> tuple[list[VisibleMesh], frozenset[str]]:
    """The strands that stay, and the names of the objects whose strands follow what moves, by name."""
    strands = [mesh for mesh in meshes if mesh.strands is not None]
    if not strands:
        return [], frozenset()
    follow = tied(list(context.view_layer.objects), moving)
    carried = frozenset(mesh.owner.name for mesh in strands if _names_that_carry(mesh) & follow)
    return [mesh for mesh in strands if mesh.owner.name not in carried], carried


def _names_that_carry(strands: VisibleMesh) -> set[str]:
    surface = surface_of(strands.owner.find())
    return {strands.owner.name, strands.source} | ({surface.name} if surface is not None else set())


def _digest(*arrays: Floats) -> str:
    found = hashlib.blake2b(digest_size=16)
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()
