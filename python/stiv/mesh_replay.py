# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs edit scripts on mesh files, without Blender.

In Object Mode, the objects of a step move or scale together. In Edit Mode, its points move: vertices with indices
within their object. Everything else is an obstacle.
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
from stiv.edit_scripts import CONSTRAINT, TRANSFORMS, EditScript, EditStep
from stiv.mesh_files import Mesh

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
SETTINGS = ("separation", "smoothness", "threads", "tight")  # options of stiv.EditOptions that a script may set


def replay_on_mesh(
    script: EditScript, mesh: Mesh, on_edit: Callable[[dict[str, Any]], None] = lambda report: None
) -> tuple[Mesh, list[dict[str, Any]]]:
    """Runs a script; returns the mesh and a report on each edit. Calls `on_edit` with each report.

    Raises InputError naming the edit for an invalid selection and for a start that intersects.
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
    """The object of each vertex, (N,); -1 without a triangle. Raises InputError for a vertex of two objects."""
    owners = np.full(len(mesh.vertices), -1, np.int32)
    owners[mesh.triangles] = mesh.triangle_object[:, None]
    shared = owners[mesh.triangles] != mesh.triangle_object[:, None]
    if shared.any():
        vertex = int(mesh.triangles[shared][0])
        raise InputError(f"vertex {vertex}: belongs to two objects; split it, so that each object has its own vertices")
    return owners


def _edit(step: EditStep, settings: Mapping[str, Any], mesh: Mesh, owners: Indices) -> tuple[stiv.EditResult, float]:
    begin = time.perf_counter()
    if step.operator not in TRANSFORMS:
        raise InputError(f"mesh files only support {', '.join(TRANSFORMS)}; run `stiv repair` to repair them")
    chosen = _objects(step, mesh)
    members = np.flatnonzero(np.isin(owners, chosen)).astype(np.int32)
    moved = members if step.points is None else members[_points(step, members)]
    if len(moved) == 0:
        raise InputError("no vertex is selected; name objects or points to move")
    kind = "deformable" if step.mode == "EDIT" or step.operator == "scale" else "rigid"
    surface = _surface(mesh, owners, chosen, kind)
    if kind == "deformable":
        joined = stiv.join_seams(surface, mesh.vertices)
    else:  # a rigid motion keeps seams closed
        joined = stiv.Welded(surface, mesh.vertices, np.arange(len(mesh.vertices), dtype=np.int32))
    moved = np.unique(joined.vertex_map[moved])
    map_of = _point_map if step.mode == "EDIT" else _object_map
    deformation, controls, goal = map_of(step, joined.positions[moved])
    whole = stiv.concatenate([(deformation, moved)], joined.positions)
    weights, axes = _constraint(step, len(controls))
    options = stiv.EditOptions(
        single_precision=False, weights=weights, weight_axes=axes, **_options({**settings, **step.settings})
    )
    result = stiv.EditSession(joined.surface, whole, controls, options).edit(goal)
    result = replace(result, surface=result.surface[joined.vertex_map])
    return result, 1000 * (time.perf_counter() - begin)


def _surface(mesh: Mesh, owners: Indices, chosen: list[int], kind: str) -> stiv.Surface:
    """The mesh with one body per object. Chosen bodies have the given mobility, all others are fixed."""
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
            raise InputError(f'there is no object "{name}"; the objects are {", ".join(mesh.object_names)}')
    return [mesh.object_names.index(name) for name in step.objects]


def _points(step: EditStep, members: Indices) -> list[int]:
    points = list(step.points or ())
    if points and max(points) >= len(members):
        raise InputError(
            f'object "{step.objects[0]}" has {len(members)} points, so point {max(points)} is out of range'
        )
    return points


def _options(settings: Mapping[str, Any]) -> dict[str, Any]:
    for name, value in settings.items():
        if name not in SETTINGS:
            raise InputError(f'setting "{name}": mesh files support {", ".join(SETTINGS)}')
        expected = "true or false" if name == "tight" else "a number"
        if not isinstance(value, int | float) or isinstance(value, bool) != (name == "tight"):
            raise InputError(f'setting "{name}": {value!r} is not {expected}')
    return {name: type(getattr(stiv.EditOptions, name))(value) for name, value in settings.items()}


def _point_map(step: EditStep, points: Floats) -> tuple[stiv.Deformation, Floats, Floats]:
    center = points.mean(axis=0)
    return stiv.identity(len(points)), points, (points - center) @ _linear(step).T + center + _shift(step)


def _object_map(step: EditStep, points: Floats) -> tuple[stiv.Deformation, Floats, Floats]:
    """One placement for all objects of the step: center, and rotation vector or factors along the world axes."""
    if step.operator == "scale":
        start = stiv.scaling_rest_controls(points)
        return stiv.scaling(points, np.eye(3)), start, np.array([start[0], step.values["value"]], float)
    start = stiv.rigid_rest_controls(points)
    turn = start[1] + _rotation_vector(step)
    return stiv.rigid(points), start, np.array([start[0] + _shift(step), turn])


def _constraint(step: EditStep, count: int) -> tuple[Floats | None, Floats | None]:
    """Response weights of the controls, (m, 3), and their axes, (m, 3, 3), that hold the axes not chosen; None: all.

    As in Blender: a move leaves no axis and does not turn, a rotation keeps its centre and its axis, and points that
    rotate stay in their planes.
    """
    chosen = step.values.get(CONSTRAINT)
    if chosen is None:
        return None, None
    flags, none = np.array(chosen, np.float64), np.zeros(3)
    if step.operator != "rotate":
        rows = {"EDIT": [flags] * count, "OBJECT": [flags, flags if step.operator == "scale" else none]}[step.mode]
        return np.array(rows), None
    axes = np.tile(_axes_from(_rotation_vector(step)), (count, 1, 1))
    along = np.array([1.0, 0.0, 0.0])
    return np.array([1 - along] * count if step.mode == "EDIT" else [none, along]), axes


def _axes_from(direction: Floats) -> Floats:
    """Orthonormal axes as columns, (3, 3), the first along a direction; the world's for the zero vector."""
    if not direction.any():
        return np.eye(3)
    first = direction / np.linalg.norm(direction)
    second = np.cross(first, np.eye(3)[np.abs(first).argmin()])
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)], axis=1)


def _shift(step: EditStep) -> Floats:
    return np.array(step.values["value"] if step.operator == "move" else (0, 0, 0), float)


def _rotation_vector(step: EditStep) -> Floats:
    if step.operator != "rotate":
        return np.zeros(3)
    axis = np.array(step.values["axis"], float)
    length = float(np.linalg.norm(axis))
    if length == 0:
        raise InputError("axis: the zero vector has no direction")
    vector: Floats = axis * (float(step.values["angle"]) / length)
    return vector


def _linear(step: EditStep) -> Floats:
    """The rotation or scale of a step as a matrix, (3, 3), by Rodrigues' formula."""
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
