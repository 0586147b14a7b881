# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of a mesh file, without Blender."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.command_line.progress import fraction_bar
from stiv.command_line.repair_report import Element, RepairChoices, RepairOutcome
from stiv.mesh_files import Mesh, read_mesh, welded_mesh, write_mesh, write_repositioned
from stiv.output_files import written_atomically

Floats = NDArray[np.float64]
Pairs = list[tuple[Element, Element]]


def repair_mesh(source: Path, output: Path, choices: RepairChoices) -> RepairOutcome:
    """Repairs a mesh file, and writes the output if it is free when read again. Raises InputError.

    An output in the format of the input only differs in positions. With `weld`, or in another format, it has polygons
    and object names, without textures and other properties.
    """
    mesh = read_mesh(source)
    if choices.weld:
        mesh = welded_mesh(mesh)
    surface = _surface_of(mesh, choices.move)
    joined = stiv.join_seams(surface, mesh.vertices)
    options = stiv.RepairOptions(
        edit=stiv.EditOptions(separation=choices.separation, time_budget=choices.time_limit),
        max_deviation=choices.max_deviation,
    )
    with fraction_bar("repair") as progress:
        result = stiv.repair(joined.surface, joined.positions, options, progress=progress)
    pairs = _named_pairs(mesh, result.pairs.tolist())
    outcome = RepairOutcome(
        result.status, result.message, result.pairs_before, pairs, result.deviation, result.contracted
    )
    if not outcome.free:
        return outcome
    positions = result.positions[joined.vertex_map]
    with written_atomically(output) as temporary:
        if choices.weld or output.suffix.lower() != source.suffix.lower():
            write_mesh(temporary, replace(mesh, vertices=positions))
        else:
            write_repositioned(source, temporary, positions)
        _check_written(temporary, surface, output)
    return outcome


def _surface_of(mesh: Mesh, move: tuple[str, ...]) -> stiv.Surface:
    """One body per object, unless objects share vertices. If `move` names objects, the others are fixed."""
    for name in move:
        if name not in mesh.object_names:
            raise InputError(
                f'there is no object "{name}"; the objects are {", ".join(map(repr, mesh.object_names[:10]))}'
            )
    owner = np.zeros(len(mesh.vertices), np.int32)
    owner[mesh.triangles] = mesh.triangle_object[:, None]
    if (owner[mesh.triangles] != mesh.triangle_object[:, None]).any():
        if move:
            raise InputError("objects share vertices, so they cannot move separately; leave out --move")
        return stiv.Surface(mesh.triangles, len(mesh.vertices))
    bodies = [stiv.Body(name, "fixed" if move and name not in move else "deformable") for name in mesh.object_names]
    return stiv.Surface(mesh.triangles, len(mesh.vertices), vertex_body=owner, bodies=bodies)


def _check_written(path: Path, surface: stiv.Surface, output: Path) -> None:
    """Raises InputError if the written file has intersections when read again."""
    written = read_mesh(path)
    joined = stiv.join_seams(stiv.Surface(
        written.triangles, len(written.vertices), vertex_body=surface.vertex_body, bodies=surface.bodies
    ), written.vertices)  # fmt: skip
    if len(stiv.find_intersections(joined.positions, joined.surface)):
        raise InputError(f"{output}: this format is not precise enough for the result; write .npz or .obj")


def _named_pairs(mesh: Mesh, pairs: list[list[int]]) -> Pairs:
    """Pairs of triangles, as objects and indices of polygons within them."""
    owner = mesh.polygon_object
    order = np.argsort(owner, kind="stable")
    first = np.searchsorted(owner[order], np.arange(len(mesh.object_names)))
    number = np.empty(len(owner), np.int64)
    number[order] = np.arange(len(owner)) - first[owner[order]]
    polygon = np.repeat(np.arange(len(owner)), np.maximum(mesh.counts - 2, 0))

    def element(triangle: int) -> Element:
        of = polygon[triangle]
        return mesh.object_names[owner[of]], "face", int(number[of])

    return [(element(a), element(b)) for a, b in pairs]
