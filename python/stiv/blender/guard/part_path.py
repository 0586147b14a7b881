# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of a new part of a mesh from its source to its place, as a rigid body that slides along other objects."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np

import stiv
from stiv.blender.edit.sessions import body_separations, open_session
from stiv.blender.guard.correction import correction_settings
from stiv.blender.guard.new_parts import split_parts
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import tested_names
from stiv.deadlines import is_over, time_left
from stiv.task import Call, Steps

STEP = 0.1  # longest step toward the goal, of the part's size
MAX_STEPS = 200


def slide_part(
    context: bpy.types.Context, settings: EditSettings, parts: Mapping[str, Flags], way: Floats, end: float
) -> Steps[Floats | None]:
    """Steps to the part, (3,), of a translation that new parts can make toward their place; None without a free start.

    parts: flags of the cage's vertices, by object. way: the translation from their source, (3,). end: the
    deadline. Raises InputError.
    """
    scene, _ = read_guarded_scene(context, settings, tested_names(context, settings), strands=True)
    split = split_parts(scene.meshes, parts)
    own = [index for index, (_, is_part) in enumerate(split) if is_part]
    if not own:
        return None
    mobility = ["rigid" if is_part else "fixed" for _, is_part in split]
    assembly = assemble([mesh for mesh, _ in split], mobility, [frozenset(parts)], settings.ignored_pairs)
    rows, start = assembly.vertices_of(own), assembly.positions.copy()
    start[rows] -= way
    deformation = stiv.concatenate([(stiv.rigid(start[rows]), rows)], start)
    controls = stiv.rigid_rest_controls(start[rows])
    options = stiv.EditOptions(
        **correction_settings(settings).shared(),
        pair_separations=body_separations(assembly, settings),
        weights=np.array([1.0, 0.0]),
    )
    try:
        session: stiv.EditSession = yield Call(
            open_session, stiv.EditSession.start, assembly.surface, deformation, controls, options
        )
    except stiv.StartIntersectsError:
        return None
    size = float(np.linalg.norm(np.ptp(start[rows], axis=0)))
    count = int(np.clip(np.ceil(np.linalg.norm(way) / (STEP * size)), 1, MAX_STEPS)) if size > 0 else 1
    for fraction in np.arange(1, count + 1) / count:
        goal = controls + [fraction * way, np.zeros(3)]
        yield Call(session.drag, session.start_drag, goal, time_budget=time_left(end))
        if is_over(end):
            break
    yield Call(session.settle, session.start_settle)
    moved: Floats = session.controls[0] - controls[0]
    return moved
