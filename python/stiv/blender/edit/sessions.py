# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the session that solves for all control sets of an assembly."""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.garments import stacked_weights
from stiv.blender.controls.joint_regions import smallest_altitude
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import RENDER
from stiv.blender.scene.exclusions import (
    excluded_bodies,
    find_excluded_triangles,
    intersecting_faces,
    intersection_text,
    loose_geometry_text,
)
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.settings import EditSettings
from stiv.seams import Seams
from stiv.task import Call, Steps
from stiv.touching import rounding_of

SKIN = 0.25  # of the altitude of small triangles: greatest minimum distance of skin from itself


def assemble_with_controls(
    meshes: Sequence[VisibleMesh],
    control_sets: Sequence[ControlSet],
    together: Sequence[frozenset[str]],
    settings: EditSettings,
) -> Assembly:
    """Assemble meshes for a session: what no control set moves is fixed, and seams that stay closed are merged."""
    mobility, seams = ["fixed"] * len(meshes), list[Seams | None]([None] * len(meshes))
    for control_set in control_sets:
        for index in control_set.surfaces:
            mobility[index] = "rigid" if control_set.role == "rigid" and control_set.placed is None else "deformable"
        for index, each in zip(control_set.surfaces, control_set.seams, strict=False):
            seams[index] = each
    untested = {pair for each in control_sets if each.posed is not None for pair in each.posed.untested}
    return assemble(meshes, mobility, together, settings.ignored_pairs, seams, untested)


def session_options(
    assembly: Assembly,
    make_deformation: Callable[[], stiv.Deformation],
    control_sets: Sequence[ControlSet],
    controls: ArrayLike,
    settings: EditSettings,
    may_touch: bool = False,
) -> stiv.EditOptions:
    """Options of a session of all control sets that starts at these stacked controls, (m, 3).

    make_deformation: returns that of `deformation_of`; called only if pairs are excluded. may_touch: whether objects
    may touch any others at the start, not only those that move with them.
    """
    frames = storage_frames([(len(each.controls), each.frame) for each in control_sets])
    exclude = None
    if len(settings.excluded):
        q = make_deformation().surface(np.asarray(controls, np.float64))
        exclude = find_excluded_triangles(settings.excluded, assembly, q, settings.threads)
    return stiv.EditOptions(
        **settings.shared(),
        pair_separations=_skin_separations(assembly, control_sets, settings) | body_separations(assembly, settings),
        weights=stacked_weights([each.weights for each in control_sets]),
        weight_axes=axes_of_all(control_sets),
        exclude=exclude,
        parts_may_cut=any(each.posed is not None for each in control_sets),  # skin folds at open seams
        overlapping=excluded_bodies(settings.excluded, assembly),
        touching=_bodies_that_may_touch(assembly, control_sets, may_touch),
        storage=frames,
    )


def _bodies_that_may_touch(assembly: Assembly, control_sets: Sequence[ControlSet], may_touch: bool) -> list[str | int]:
    """The bodies that the goal moves, or all, if there are several. Poses do not limit what touches."""
    if any(each.posed is not None for each in control_sets):
        return []
    if may_touch:
        return list(range(len(assembly.surface.bodies)))
    moving = {index for each in control_sets if each.rule.moves for index in each.surfaces}
    starts = [assembly.starts[index] for index in moving if assembly.starts[index] < assembly.starts[index + 1]]
    bodies = np.unique(assembly.surface.vertex_body[starts]).tolist() if starts else []
    return bodies if len(bodies) > 1 else []


def make_session(
    assembly: Assembly, deformation: stiv.Deformation, controls: ArrayLike, options: stiv.EditOptions
) -> Steps[stiv.EditSession]:
    """Steps that make a session of all control sets, from their stacked controls, (m, 3).

    deformation: of `deformation_of`. Raises InputError, StartIntersectsError.
    """
    try:
        session: stiv.EditSession = yield Call(
            open_session, stiv.EditSession.start, assembly.surface, deformation, controls, options,
            [each.obstacle for each in assembly.obstacles],
        )  # fmt: skip
        return session
    except stiv.StartIntersectsError as error:
        raise ObjectsIntersectError(error, assembly) from error


def _skin_separations(
    assembly: Assembly, control_sets: Sequence[ControlSet], settings: EditSettings
) -> dict[tuple[str | int, str | int], float]:
    """Minimum distances of posed bodies from themselves.

    A mesh finer than the minimum distance is nearer to itself everywhere. It turns with its bones, which would count
    as an approach.
    """
    found: dict[tuple[str | int, str | int], float] = {}
    kept = 4 * rounding_of(assembly.positions)  # the least in storage
    for index in (index for each in control_sets if each.posed is not None for index in each.surfaces):
        mesh = assembly.meshes[index]
        if settings.separation > 0 and len(mesh.triangles):
            body = int(assembly.surface.vertex_body[assembly.starts[index]])
            least = min(settings.separation, max(kept, SKIN * smallest_altitude(mesh)))
            found[body, body] = min(least, found.get((body, body), least))
    return found


class ObjectsIntersectError(stiv.StartIntersectsError):
    """A start that intersects.

    Attributes:
        assembly: with the triangles of the session.
        pairs: intersecting pairs of triangles, (k, 2).
        objects: pairs of objects with the number of their intersecting faces; not of an object with itself.
        short: a message about the first pair of objects; "" without any.
    """

    def __init__(self, error: stiv.StartIntersectsError, assembly: Assembly) -> None:
        super().__init__(str(error) if len(error.pairs) else loose_text(assembly) or str(error))
        self.pairs: Indices = error.pairs
        self.assembly = assembly
        if intersects_only_in_render(assembly, error):
            self.add_note("only the render intersects; set Guard to Viewport to leave it out")

    @cached_property
    def objects(self) -> tuple[tuple[str, str, int], ...]:
        """See the attributes. Most starts that intersect begin again, with exclusions, and need no message."""
        return intersecting_faces(self.assembly, self.pairs)

    @cached_property
    def short(self) -> str:
        """See the attributes."""
        return intersection_text(*self.objects[0]) if self.objects else ""


def loose_text(assembly: Assembly) -> str:
    """A message about a loose edge or vertex that cuts a face, of another object if one does; empty if none does."""
    found = find_face_pairs(assembly, assembly.positions, intersecting=np.empty((0, 2), np.int32))
    names = sorted(((pair.first.object, pair.second.object) for pair in found), key=lambda each: each[0] == each[1])
    return loose_geometry_text(*names[0]) if names else ""


def open_session(*given: Any, **_execution: Any) -> stiv.EditSession:
    """Make a session at once, for `Call`: it takes no cancellation and reports no progress."""
    return stiv.EditSession(*given)


def intersects_only_in_render(assembly: Assembly, error: stiv.StartIntersectsError) -> bool:
    """Does the start intersect only in the render?"""
    pairs, _ = assembly.face_pairs(error.pairs)
    return len(pairs) > 0 and bool(pairs.where(lambda *both: RENDER in (each.evaluation for each in both)).all())


def axes_of_all(control_sets: Sequence[ControlSet]) -> Floats | None:
    """Stacked weight axes of all control sets, (m, 3, 3); None if all use the world axes."""
    if all(each.weight_axes is None for each in control_sets):
        return None
    world = np.eye(3)
    return np.concatenate(
        [
            np.broadcast_to(world, (len(p.controls), 3, 3)) if p.weight_axes is None else p.weight_axes
            for p in control_sets
        ]
    )


def deformation_of(assembly: Assembly, control_sets: Sequence[ControlSet]) -> stiv.Deformation:
    """Deformation of all control sets; other vertices stay where the assembly has them."""
    return stiv.concatenate(
        [(each.deformation, assembly.vertices_of(each.surfaces)) for each in control_sets], assembly.positions
    )


def stack_controls(controls: Sequence[Floats]) -> Floats:
    """Stack the controls of several control sets."""
    return np.concatenate([np.empty((0, 3)), *controls])


def split_controls(controls: Floats, control_sets: Sequence[ControlSet]) -> list[Floats]:
    """Split stacked controls into those of each control set, (m, 3)."""
    return np.split(controls, np.cumsum([len(each.controls) for each in control_sets])[:-1])


def storage_frames(stored: Sequence[tuple[int, Floats | None]]) -> list[stiv.StorageFrame]:
    """How stacked controls are stored, from the number and frame of each control set.

    Without any frame, one for no controls: Blender evaluates their surface in single precision all the same, and its
    rounding must not count as penetration.
    """
    firsts = np.cumsum([0, *(count for count, _ in stored)]).tolist()
    rows = zip(firsts, stored, strict=False)
    frames = [stiv.StorageFrame(first, count, frame) for first, (count, frame) in rows if frame is not None]
    return frames or [stiv.StorageFrame(0, 0, np.eye(4))]


def write_controls(control_sets: Sequence[ControlSet], controls: Floats, start: Floats) -> None:
    """Write stacked controls, (m, 3), and update Blender's evaluation. Unchanged control sets are restored.

    Raises SceneChangedError if an object was removed or changed.
    """
    rows = zip(control_sets, split_controls(controls, control_sets), split_controls(start, control_sets), strict=True)
    for control_set, row, before in rows:
        if np.array_equal(row, before):
            control_set.writer.restore()
        else:
            control_set.writer.write(row)
    bpy.context.view_layer.update()


def restore_controls(control_sets: Sequence[ControlSet]) -> None:
    """Restore the start exactly. Raises SceneChangedError if an object was removed."""
    for control_set in control_sets:
        control_set.writer.restore()
    bpy.context.view_layer.update()


def body_separations(assembly: Assembly, settings: EditSettings) -> dict[tuple[str | int, str | int], float]:
    """Minimum distances of pairs of objects as those of pairs of bodies."""
    bodies: dict[str, list[int]] = {}
    for number, body in enumerate(assembly.surface.bodies):
        bodies.setdefault(body.name, []).append(number)
    return {
        (a, b): distance
        for first, second, distance in settings.pair_separations
        for a in bodies.get(settings.shown_by(first), [])
        for b in bodies.get(settings.shown_by(second), [])
    }
