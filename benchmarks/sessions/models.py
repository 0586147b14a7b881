# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 9 and 1 with models from a folder: the Stanford bunny in Newell's teapot, and a dressed ogre.

Each model is welded and repaired first. Only the largest component of the ogre is used, its body. The
others, eyes, teeth and a loincloth, intersect it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import stiv
from benchmarks.sessions.running import Array, Report, record
from benchmarks.sessions.table1 import row
from blend_fixtures.scenes.sessions import real_models
from blend_fixtures.scenes.shape import Shape
from stiv import InputError
from stiv.mesh_files import read_mesh

FIGURES = {
    "bunny": ("animal_in_teapot", ("stanford-bunny.obj", "teapot.obj")),
    "ogre": ("dressed_figure", ("ogre.obj",)),
}
LARGEST_PART_OF = ("ogre.obj",)


def models(folder: Path, threads: Sequence[int], report: Report) -> list[dict[str, Any]]:
    """One row per figure and number of threads, as in the table. Reports and skips figures without files.

    Raises InputError for a missing folder, and for a model that cannot be repaired.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder")
    rows = []
    for name, (figure, files) in FIGURES.items():
        missing = [file for file in files if not (folder / file).is_file()]
        if missing:
            report(f"nothing of {name}: {folder} has no {', '.join(missing)}")
            continue
        shapes = [repaired(folder / file, report) for file in files]
        session = getattr(real_models, figure)(*shapes)
        for count in threads:
            recorded, figures = record(session, {"threads": count}, report)
            rows.append(row(name, "stiv", "many", count, recorded, figures, figures))
    return rows


def repaired(path: Path, report: Report) -> Any:
    """Reads a model and repairs it. Raises InputError if it cannot be repaired."""
    mesh = read_mesh(path)
    given = np.asarray(mesh.vertices, float)
    whole = stiv.weld(stiv.Surface(mesh.triangles, len(given)), given)
    positions, triangles = whole.positions, whole.surface.triangles
    if path.name in LARGEST_PART_OF:
        positions, triangles = largest_part(positions, triangles)
    begin = time.process_time()
    options = stiv.RepairOptions(edit=stiv.EditOptions(threads=1))
    result = stiv.repair(stiv.Surface(triangles, len(positions)), positions, options)
    seconds = time.process_time() - begin
    if result.status not in ("already_free", "repaired"):
        raise InputError(f"{path}: {result.status}: {result.message}")
    report(
        f"{path.name}: {len(positions)} vertices, {result.status}, {result.pairs_before} pairs before, "
        f"deviation {result.deviation:.2%}, {seconds:.1f} s"
    )
    return Shape(result.positions, tuple(map(tuple, result.surface.triangles.tolist())))


def largest_part(positions: Array, triangles: Any) -> tuple[Array, Any]:
    """The component with the most vertices, and its triangles."""
    label = np.arange(len(positions))
    while True:  # each vertex takes the least label of its triangles, and that label's own: halving the way each time
        least = label.copy()
        np.minimum.at(least, triangles.ravel(), np.repeat(label[triangles].min(axis=1), 3))
        least = least[least]
        if np.array_equal(least, label):
            break
        label = least
    kept = label == np.bincount(label).argmax()
    number = np.cumsum(kept) - 1
    return positions[kept], number[triangles[kept[triangles[:, 0]]]].astype(np.int32)


def models_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per row, as in the table."""
    lines = [
        f"{'Model':9} {'threads':>7} {'Vertices':>8} {'Triangles':>9} {'Edits':>6} {'Collisions':>10} {'Regions':>7} "
        f"{'Iterations':>10} {'ms/iteration':>12} {'ms/edit':>8} {'left':>5}"
    ]
    for r in rows:
        lines.append(
            f"{r['scene']:9} {r['threads']:7d} {r['vertices']:8d} {r['triangles']:9d} {r['edits']:6d} "
            f"{r['collisions']:10.2f} {r['regions']:7.2f} {r['iterations']:10.2f} {r['ms_per_iteration']:12.1f} "
            f"{r['ms_per_edit']:8.1f} {r['intersections']:5d}"
        )
    return "\n".join(lines)
