# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the edits that end furthest from the converged solution: start, edit and solution side by side."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.quality.cases import cases
from benchmarks.quality.comparison import energy_ratios
from stiv import InputError

Array = NDArray[np.float64]
PANELS = ("start", "edit", "ipc")
VIEW = {"elev": 25.0, "azim": -60.0}
LIGHT = np.array([0.3, -0.6, 0.74])
MOVING, FIXED = np.array([0.9, 0.55, 0.2]), np.array([0.6, 0.65, 0.7])
FIXED_OPACITY = 0.25


def worst(rows: Sequence[dict[str, Any]], count: int = 3) -> list[str]:
    """The edits with the largest energy relative to the solution."""
    ratios = energy_ratios(rows, "edit")
    return sorted(ratios, key=lambda name: -ratios[name])[:count]


def draw_worst(
    models: Path, rows: Sequence[dict[str, Any]], surfaces: dict[str, dict[str, Array]], folder: Path
) -> None:
    """Write a PNG file for each of the worst three edits. Raises InputError without Matplotlib."""
    try:
        figures = importlib.import_module("matplotlib.figure")
        solids = importlib.import_module("mpl_toolkits.mplot3d.art3d")
    except ModuleNotFoundError as error:
        raise InputError("bench quality --pictures needs Matplotlib: pip install matplotlib") from error
    folder.mkdir(parents=True, exist_ok=True)
    for name in worst(rows):
        edit = cases(models)[name]()
        start, goal = edit.deformation.surface(edit.controls), edit.deformation.surface(edit.goal)
        shown = {"start": start, **surfaces[name]}
        triangles = edit.surface.triangles
        moves = np.any(start != goal, axis=1)[triangles].any(axis=1)
        figure = figures.Figure(figsize=(12, 4.5))
        low = np.min([shown[panel].min(axis=0) for panel in PANELS], axis=0)
        high = np.max([shown[panel].max(axis=0) for panel in PANELS], axis=0)
        for place, panel in enumerate(PANELS):
            axes = figure.add_subplot(1, len(PANELS), place + 1, projection="3d", **VIEW)
            corners = shown[panel][triangles]
            axes.add_collection3d(solids.Poly3DCollection(corners, facecolors=_colors(corners, moves)))
            axes.set(title=panel, xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
            axes.set_box_aspect(high - low)
            axes.set_axis_off()
        figure.suptitle(f"{name}: energy {energy_ratios(rows, 'edit')[name]:.2f} of the converged solution's")
        figure.savefig(folder / f"{name.replace(' ', '_')}.png", dpi=100)


def _colors(corners: Array, moves: NDArray[np.bool_]) -> Array:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    shade = 0.55 + 0.45 * np.abs(normals @ LIGHT)[:, None]
    opacity = np.where(moves, 1.0, FIXED_OPACITY)[:, None]
    return np.hstack([shade * np.where(moves[:, None], MOVING, FIXED), opacity])
