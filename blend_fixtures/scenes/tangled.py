# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersecting surfaces for repair: tubes bent through themselves, an arm in a body, a body that cuts a shirt."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv

from .detection_steps import rounded_box
from .primitives import grid, icosphere, triangulated
from .shape import Shape, joined, rotation_matrix
from .sweeps import tube
from .voxels import voxel_surface

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tangle:
    """A surface and its intersecting positions (N, 3)."""

    name: str
    surface: stiv.Surface
    positions: Array


def _tangle(name: str, **shapes: Shape) -> Tangle:
    """Concatenated shapes, each a separate deformable body."""
    whole = joined(list(shapes.values()))
    owner = np.repeat(np.arange(len(shapes)), [len(shape.vertices) for shape in shapes.values()])
    bodies = [stiv.Body(body) for body in shapes]
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    return Tangle(name, surface, whole.vertices)


def hairpin(radius: float, rings: int = 70, sides: int = 12) -> Tangle:
    """A tube of the given radius that turns back on itself; the axes of its legs are 0.45 apart."""
    along = np.linspace(0, 1, rings)
    turn = np.pi * np.clip((along - 0.4) / 0.2, 0, 1)
    length = 3.5 / rings
    path = np.stack([length * np.cumsum(np.cos(turn)), length * np.cumsum(np.sin(turn)), 0.02 * along], axis=1)
    return _tangle(f"hairpin {radius:g}", tube=tube(path, np.full(rings, radius), sides))


def figure(levels: int = 3) -> Shape:
    """A figure with head, legs, and arms along x: a Catmull-Clark surface with about 6,000 vertices."""
    torso = set(itertools.product(range(-1, 2), (0, 1), range(4)))
    legs = set(itertools.product((-1, 1), (0,), range(-4, 0)))
    arms = set(itertools.product((*range(-6, -1), *range(2, 7)), (0,), (3,)))
    head = {(0, 0, 4), (0, 0, 5)}
    cage = voxel_surface(torso | legs | arms | head).moved((-0.5, -0.5, 0))
    deformation, triangles = stiv.catmull_clark(stiv.Cage.of_faces(cage.faces), levels)
    return Shape(deformation.surface(cage.vertices), tuple(map(tuple, triangles.tolist())))


def arm_in_body(angle: float = 1.9, levels: int = 3) -> Tangle:
    """The figure with one arm bent down at the shoulder by `angle` radians, into the side of the body."""
    shape = figure(levels)
    shoulder, width = np.array([1.9, 0.0, 3.5]), 0.8
    share = np.clip((shape.vertices[:, 0] - shoulder[0]) / width + 0.5, 0, 1)
    share = share * share * (3 - 2 * share)
    bent = [
        rotation_matrix((0, angle * part, 0)) @ point
        for part, point in zip(share, shape.vertices - shoulder, strict=True)
    ]
    return _tangle(f"arm in body {angle:g}", figure=Shape(np.array(bent) + shoulder, shape.faces))


def shirt_cut_by_torso(cuts: int = 26, cells: int = 56) -> Tangle:
    """A torso with hills that protrude from its open shirt in many places."""
    torso = rounded_box(cuts, 0.12).scaled((0.8, 0.55, 1.2))
    sheet = triangulated(grid(cells, cells // 2, 2 * np.pi, 1.5))
    angle, height = sheet.vertices[:, 0], sheet.vertices[:, 1]
    around = np.round((angle / (2 * np.pi) + 0.5) * cells).astype(int) % cells
    out = np.sqrt(1 - (height / 1.2) ** 2)
    place = np.stack([0.82 * out * np.cos(angle), 0.565 * out * np.sin(angle), height], axis=1)
    rows = cells // 2 + 1
    kept = around * rows + np.tile(np.arange(rows), cells + 1)  # the last column is the first again
    faces = tuple(tuple(int(kept[i]) for i in face) for face in sheet.faces)
    return _tangle("shirt", torso=torso, shirt=Shape(place[: cells * rows], faces))


def coincident_spheres(levels: int = 3) -> Tangle:
    """Two spheres in the same place: neither is inside the other."""
    return _tangle("coincident", first=icosphere(levels), second=icosphere(levels))


def all_tangles() -> tuple[Tangle, ...]:
    """The scenes for measuring repair: the first four can be repaired, the last cannot."""
    return hairpin(0.25), hairpin(0.32), arm_in_body(), shirt_cut_by_torso(), coincident_spheres()
