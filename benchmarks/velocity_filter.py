# SPDX-License-Identifier: GPL-3.0-or-later
"""A subdivision face pressed into waves: the response through its cage, and a velocity filter.

The filter follows Bridson, Fedkiw and Anderson (2002), for comparison only: each contact changes the
velocities of its own vertices by an inelastic impulse along its normal, in repeated passes until there are no
contacts. Vertices that remain in contact then stop at the time of the first contact. This is the paper's
Figure 7.

Prints for both: exact intersections, the achieved fraction of the motion, and the roughness of the face.
`python -m benchmarks.velocity_filter [--json FILE] [--npz FILE]`
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.sessions.face_into_waves import stage

Array = NDArray[np.float64]
PASSES = 200


def filtered(surface: stiv.Surface, start: Array, goal: Array, moves: NDArray[np.bool_], separation: float) -> Array:
    """Positions (N, 3) after the filter, which changes only the velocities of vertices marked in `moves`."""
    end = goal.copy()
    mass = moves.astype(float)  # inverse masses: static vertices are infinitely heavy
    for _ in range(PASSES):
        events = stiv.find_interference(surface, start, end, separation)
        if len(events.time) == 0:
            return end
        _apply_impulses(events, start, end, mass, separation)
    first = float(stiv.find_interference(surface, start, end, separation).time.min(initial=1.0))
    return start + 0.9 * first * (end - start)


def _apply_impulses(events: stiv.Events, start: Array, end: Array, mass: Array, separation: float) -> None:
    """One pass over the contacts by time: removes the remaining approach, and restores the separation."""
    for k in np.argsort(events.time, kind="stable"):
        vertices, weights, normal = events.vertices[k], events.weights[k], events.normal[k]
        gap = normal @ (weights @ end[vertices])  # along the normal at contact, at the end of the step
        share = weights * mass[vertices]
        heaviness = weights @ share
        if gap < 2 * separation and heaviness > 0:
            end[vertices] += np.outer(share, normal) * (2 * separation - gap) / heaviness


def vertex_normals(positions: Array, triangles: NDArray[np.int32]) -> Array:
    """Unit normals (N, 3), weighted by the areas of the adjacent triangles."""
    a, b, c = positions[triangles].transpose(1, 0, 2)
    total = np.zeros_like(positions)
    for corner in range(3):
        np.add.at(total, triangles[:, corner], np.cross(b - a, c - a))
    unit: Array = total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None]
    return unit


def roughness(positions: Array, triangles: NDArray[np.int32]) -> float:
    """Root mean square over vertices of the second difference of normals: the mean around a vertex minus its
        own.

    Approximately in radians; at half the edge length, a smooth surface with the same bend has a quarter of it.
    """
    normals = vertex_normals(positions, triangles)
    ends = np.unique(np.sort(np.concatenate([triangles[:, [k, k - 1]] for k in range(3)]), axis=1), axis=0)
    total, count = np.zeros_like(normals), np.zeros(len(normals))
    for near, far in ((ends[:, 0], ends[:, 1]), (ends[:, 1], ends[:, 0])):
        np.add.at(total, near, normals[far])
        np.add.at(count, near, 1)
    used = count > 0
    differences = total[used] / count[used, None] - normals[used]
    return float(np.sqrt((differences**2).sum(axis=1).mean()))


def compare(share: float = 1.0) -> tuple[dict[str, dict[str, float]], dict[str, Array]]:
    """Figures and positions of the start, the goal (a fraction of the motion), our result, and the filter's."""
    scene = stage()
    session = stiv.EditSession(scene.surface, scene.deformation, scene.controls)
    goal = scene.controls + share * (scene.edits[0](scene.controls) - scene.controls)
    start, wanted = session.surface, scene.deformation.surface(goal)
    ours = session.edit(goal).surface
    moves = scene.surface.vertex_body == 0
    theirs = filtered(scene.surface, start, wanted, moves, session.separation)
    states = {"start": start, "wanted": wanted, "ours": ours, "filter": theirs}
    face = scene.surface.triangles[(moves[scene.surface.triangles]).all(axis=1)]
    way = max(np.linalg.norm(wanted - start), 1e-300)
    figures = {
        name: {
            "roughness": roughness(state[moves], face),
            "kept": float(1 - np.linalg.norm(state - wanted) / way),
            "intersections": float(len(stiv.find_intersections(state, scene.surface))),
        }
        for name, state in states.items()
    }
    return figures, states


def main() -> None:
    """Print the comparison, and optionally write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    parser.add_argument("--npz", type=Path, help="file to write the positions to")
    arguments = parser.parse_args()
    figures, states = compare()
    unit = figures["start"]["roughness"]
    print(f"{'':8} {'roughness':>9} {'of start':>8} {'kept':>6} {'intersections':>13}")
    for name, values in figures.items():
        print(
            f"{name:8} {values['roughness']:9.4f} {values['roughness'] / unit:8.2f} {values['kept']:6.3f} "
            f"{values['intersections']:13.0f}"
        )
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    if arguments.npz:
        np.savez_compressed(arguments.npz, **states)


if __name__ == "__main__":
    main()
