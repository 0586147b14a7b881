# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of meshes from files: a shell shrunk onto each mesh, and one mesh of each pair grown inside the other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.detection_steps import Step, rounded_box
from stiv.mesh_files import read_mesh

Array = NDArray[np.float64]
CONTACT, BEYOND = 0.98, 1.012  #: the step grows from this fraction of the size of first contact to that size


def free_triangles(vertices: Array, triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """The triangles that intersect no other one; self-intersections of the original mesh are omitted."""
    pairs = stiv.find_intersections(vertices, triangles)
    return np.delete(triangles, np.unique(pairs), axis=0)


def _centred(vertices: Array) -> Array:
    middle: Array = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    return vertices - middle


def growing_inside(name: str, inner: tuple[Array, NDArray[np.int32]], outer: tuple[Array, NDArray[np.int32]]) -> Step:
    """A step in which the inner mesh grows about the centre of the outer one, slightly beyond first contact."""
    (inside, inner_triangles), (outside, outer_triangles) = inner, outer
    triangles = np.concatenate([inner_triangles, outer_triangles + np.int32(len(inside))])
    detector = stiv.Detector(triangles)
    unit = inside / np.linalg.norm(inside, axis=1).max()

    def sized(size: float) -> Array:
        return np.concatenate([size * unit, outside])

    size, time = 0.5 * float(np.linalg.norm(outside, axis=1).min()), np.inf
    while time > 1:  # small steps, because the swept boxes of a large one overlap too many others
        time = detector.earliest_time(sized(size), sized(1.03 * size))
        size *= 1 + 0.03 * min(time, 1.0)
    return Step(name, triangles, sized(CONTACT * size), sized(BEYOND * size))


def steps(folder: Path) -> list[Step]:
    """All steps from the meshes of a folder, sorted by name."""
    meshes: dict[str, tuple[Array, NDArray[np.int32]]] = {}
    for path in sorted(folder.glob("*.obj")):
        mesh = read_mesh(path)
        welded = stiv.weld(mesh.triangles, _centred(np.asarray(mesh.vertices, float)))
        vertices, triangles = welded.positions, welded.surface.triangles
        kept = free_triangles(vertices, triangles)
        print(f"{path.name}: {len(mesh.triangles)} triangles, {len(mesh.triangles) - len(kept)} of them left out")
        meshes[path.stem] = vertices, kept
    result = []
    for name, (vertices, triangles) in meshes.items():
        shell = rounded_box(23)
        around = 1.02 * np.linalg.norm(vertices, axis=1).max() * shell.vertices
        result.append(growing_inside(f"{name} in shell", (vertices, triangles), (around, shell.triangles())))
    return result + _pairs(meshes)


def _pairs(meshes: dict[str, tuple[Array, NDArray[np.int32]]]) -> list[Step]:
    names = list(meshes)
    pairs = [(a, b) for a in names for b in names if len(meshes[a][1]) > len(meshes[b][1])]
    return [growing_inside(f"{a} in {b}", meshes[a], meshes[b]) for a, b in pairs]
