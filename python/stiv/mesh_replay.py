# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs edit scripts on mesh files, without Blender.

In Object Mode the objects of a step move as one, or are scaled; in Edit Mode its points move, which are vertices
counted within their object. Everything else is in the way and stays.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.edit_scripts import TRANSFORMS, EditScript, EditStep
from stiv.mesh_files import Mesh

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
SETTINGS = ("separation", "smoothness", "threads")  # options of stiv.EditOptions that a script may set


def replay_on_mesh(
    script: EditScript, mesh: Mesh, on_edit: Callable[[dict[str, Any]], None] = lambda report: None
) -> tuple[Mesh, list[dict[str, Any]]]:
    """The mesh after every edit of the script, and what each one did; `on_edit` is told of each when it is done.

    Raises InputError, naming the edit, for what cannot be selected and for a start that intersects.
    """
    owners = vertex_objects(mesh)
    reports: list[dict[str, Any]] = []
    for step in script.edits():
        try:
            result, milliseconds = _edit(step, script.settings, mesh, owners)
        except InputError as error:
            raise InputError(f"edit {len(reports)} ({step.operator}): {error}") from error
        mesh = replace(mesh, vertices=result.surface)
        reports.append(_report(step, result, len(reports), milliseconds))
        on_edit(reports[-1])
    return mesh, reports


def vertex_objects(mesh: Mesh) -> Indices:
    """The object of each vertex, (N,); -1 for those of no triangle. Raises InputError for a vertex of two objects."""
    owners = np.full(len(mesh.vertices), -1, np.int32)
    owners[mesh.triangles] = mesh.triangle_object[:, None]
    shared = owners[mesh.triangles] != mesh.triangle_object[:, None]
    if shared.any():
        vertex = int(mesh.triangles[shared][0])
        raise InputError(f"vertex {vertex}: belongs to triangles of two objects; give each object vertices of its own")
    return owners


def _edit(step: EditStep, settings: Mapping[str, Any], mesh: Mesh, owners: Indices) -> tuple[stiv.EditResult, float]:
    begin = time.perf_counter()
    if step.operator not in TRANSFORMS:
        raise InputError(f"mesh files take {', '.join(TRANSFORMS)} alone; `stiv repair` repairs them")
    chosen = _objects(step, mesh)
    members = np.flatnonzero(np.isin(owners, chosen)).astype(np.int32)
    moved = members if step.points is None else members[_points(step, members)]
    if len(moved) == 0:
        raise InputError("nothing is selected that may move")
    kind = "deformable" if step.mode == "EDIT" or step.operator == "scale" else "rigid"
    surface = _surface(mesh, owners, chosen, kind)
    if kind == "deformable":
        joined = stiv.join_seams(surface, mesh.vertices)
    else:  # what keeps its shape keeps its seams
        joined = stiv.Welded(surface, mesh.vertices, np.arange(len(mesh.vertices), dtype=np.int32))
    moved = np.unique(joined.vertex_map[moved])
    map_of = _point_map if step.mode == "EDIT" else _object_map
    deformation, controls, goal = map_of(step, joined.positions[moved])
    whole = stiv.concatenate([(deformation, moved)], joined.positions)
    options = stiv.EditOptions(single_precision=False, **_options({**settings, **step.settings}))
    result = stiv.EditSession(joined.surface, whole, controls, options).edit(goal)
    result = replace(result, surface=result.surface[joined.vertex_map])
    return result, 1000 * (time.perf_counter() - begin)


def _surface(mesh: Mesh, owners: Indices, chosen: list[int], kind: str) -> stiv.Surface:
    """The mesh with one body an object, those chosen of a mobility, all others fixed."""
    bodies = [stiv.Body(name, kind if index in chosen else "fixed") for index, name in enumerate(mesh.object_names)]
    loose = stiv.Body("loose vertices", "fixed")
    return stiv.Surface(
        mesh.triangles,
        len(mesh.vertices),
        None,
        np.where(owners < 0, len(bodies), owners).astype(np.int32),
        [*bodies, loose],
        [(a, b) for a in chosen for b in chosen if a <= b] if kind == "rigid" else [],
    )


def _objects(step: EditStep, mesh: Mesh) -> list[int]:
    for name in step.objects:
        if name not in mesh.object_names:
            raise InputError(f'there is no object "{name}"; there are {", ".join(mesh.object_names)}')
    return [mesh.object_names.index(name) for name in step.objects]


def _points(step: EditStep, members: Indices) -> list[int]:
    points = list(step.points or ())
    if points and max(points) >= len(members):
        raise InputError(f'object "{step.objects[0]}" has {len(members)} points; there is no point {max(points)}')
    return points


def _options(settings: Mapping[str, Any]) -> dict[str, Any]:
    for name, value in settings.items():
        if name not in SETTINGS:
            raise InputError(f'setting "{name}": of mesh files there are {", ".join(SETTINGS)}')
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise InputError(f'setting "{name}": {value!r} is not a number')
    return {name: type(getattr(stiv.EditOptions, name))(value) for name, value in settings.items()}


def _point_map(step: EditStep, points: Floats) -> tuple[stiv.Deformation, Floats, Floats]:
    centre = points.mean(axis=0)
    return stiv.identity(len(points)), points, (points - centre) @ _linear(step).T + centre + _shift(step)


def _object_map(step: EditStep, points: Floats) -> tuple[stiv.Deformation, Floats, Floats]:
    """One placement for all objects of the step: centre, and rotation vector or factors along the world's axes."""
    if step.operator == "scale":
        start = stiv.scaling_rest_controls(points)
        return stiv.scaling(points, np.eye(3)), start, np.array([start[0], step.values["value"]], float)
    start = stiv.rigid_rest_controls(points)
    turn = start[1] + _rotation_vector(step)
    return stiv.rigid(points), start, np.array([start[0] + _shift(step), turn])


def _shift(step: EditStep) -> Floats:
    return np.array(step.values["value"] if step.operator == "move" else (0, 0, 0), float)


def _rotation_vector(step: EditStep) -> Floats:
    if step.operator != "rotate":
        return np.zeros(3)
    axis = np.array(step.values["axis"], float)
    length = float(np.linalg.norm(axis))
    if length == 0:
        raise InputError("axis: has no direction")
    vector: Floats = axis * (float(step.values["angle"]) / length)
    return vector


def _linear(step: EditStep) -> Floats:
    """The step's rotation or scale as a matrix, (3, 3). (Rodrigues)"""
    if step.operator == "scale":
        return np.diag(np.array(step.values["value"], float))
    vector = _rotation_vector(step)
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix: Floats = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def _report(step: EditStep, result: stiv.EditResult, number: int, milliseconds: float) -> dict[str, Any]:
    return {
        "number": number,
        "operator": step.operator,
        "milliseconds": round(milliseconds, 3),
        "status": result.status,
        "rounds": result.rounds,
        "events": len(result.events),
        "patches": result.patches,
        "energy": result.energy,
        "blocking": list(result.blocking),
    }
