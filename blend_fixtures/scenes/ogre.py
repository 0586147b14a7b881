# SPDX-License-Identifier: GPL-3.0-or-later
"""An ogre and its clothes, as triangle cages: a shirt made for someone slimmer, glasses and a hat.

Lengths are in units of half its height; it stands on z = 0 and looks along -y.
"""

from __future__ import annotations

import numpy as np

from .fields import ellipsoid, limb, merged, mirrored, path, ring
from .fixture import Triple
from .primitives import triangulated
from .shape import Shape
from .surface_nets import surface_net
from .sweeps import revolution

SHOULDER, HAND = (0.3, 0.0, 1.3), (1.1, -0.06, 1.16)
HEAD = (0.0, -0.03, 1.72)


def ogre(cell: float = 0.1416) -> Shape:
    """The ogre: belly, chest, short legs, long arms, and a wide head with ears and a nose."""
    trunk = merged(
        ellipsoid((0, 0.0, 1.12), (0.4, 0.29, 0.36)), ellipsoid((0, -0.06, 0.83), (0.4, 0.36, 0.36)), smooth=0.2
    )
    head = merged(
        ellipsoid(HEAD, (0.235, 0.25, 0.25)),
        ellipsoid((0, -0.1, 1.58), (0.2, 0.19, 0.14)),
        ellipsoid((0, -0.31, 1.66), (0.07, 0.08, 0.075)),
        smooth=0.08,
    )
    neck = limb((0, 0, 1.3), (0, -0.02, 1.6), 0.19, 0.18)
    side = merged(
        path([SHOULDER, (0.7, -0.01, 1.24), HAND], [0.165, 0.14, 0.115]),
        ellipsoid((1.2, -0.08, 1.14), (0.16, 0.12, 0.1)),
        path([(0.19, 0, 0.62), (0.23, 0.01, 0.35), (0.24, 0, 0.16)], [0.19, 0.155, 0.14]),
        ellipsoid((0.25, -0.09, 0.12), (0.145, 0.24, 0.125)),
        limb((0.2, -0.02, 1.74), (0.42, 0.0, 1.86), 0.1, 0.09),
        smooth=0.07,
    )
    whole = merged(trunk, neck, head, mirrored(side), smooth=0.09)
    return triangulated(surface_net(whole, (-10.5 * cell, -0.6, -0.1), (10.5 * cell, 0.6, 2.2), cell, 8))


SLEEVE = ((0.22, 0, 1.22), (0.95, -0.03, 1.2))


def shirt(cell: float = 0.136, sleeve_line: tuple[Triple, Triple] = SLEEVE) -> Shape:
    """An open shirt with short sleeves along a line and a slim waist, made for another body."""
    waist = path(
        [(0, 0, 0.45), (0, 0, 0.82), (0, -0.03, 1.1), (0, 0, 1.24), (0, 0, 1.6)], [0.38, 0.32, 0.36, 0.33, 0.2]
    )
    sleeve = path(list(sleeve_line), [0.27, 0.16])
    slim = merged(waist, mirrored(sleeve), smooth=0.08)
    whole = surface_net(slim, (-1.3, -0.6, 0.0), (1.3, 0.6, 1.9), cell, 8)
    cuts = ((2, 0.55, -1.0), (2, 1.47, 1.0), (0, 0.66, 1.0), (0, -0.66, -1.0))  # axis, position, side to remove
    middle = np.array([whole.vertices[list(face)].mean(axis=0) for face in whole.faces])
    kept = np.all([side * (middle[:, axis] - place) < 0 for axis, place, side in cuts], axis=0)
    return triangulated(_hemmed(_without_unused(whole, kept), cuts))


def _without_unused(shape: Shape, kept: np.ndarray) -> Shape:
    """The shape with only the marked faces and their vertices."""
    faces = np.array(shape.faces)[kept]
    used, renumbered = np.unique(faces, return_inverse=True)
    return Shape(shape.vertices[used], tuple(map(tuple, renumbered.reshape(faces.shape).tolist())))


def _hemmed(shape: Shape, cuts: tuple[tuple[int, float, float], ...]) -> Shape:
    """The shape with boundary vertices moved onto the plane of the cut."""
    sides = [(face[i - 1], face[i]) for face in shape.faces for i in range(len(face))]
    twins = set(sides)
    rim = np.array(sorted({a for a, b in sides if (b, a) not in twins}))
    vertices = shape.vertices.copy()
    away = np.stack([np.abs(vertices[rim, axis] - place) for axis, place, _ in cuts], axis=1)
    for vertex, nearest in zip(rim, away.argmin(axis=1), strict=True):
        axis, place, _ = cuts[nearest]
        vertices[vertex, axis] = place
    return Shape(vertices, shape.faces)


def glasses(cell: float = 0.04) -> Shape:
    """Round glasses with temples that hook behind the ears, for a narrower head, placed in front of this one."""
    side = merged(
        ring((0.13, 0, 0), 1, 0.095, 0.038),
        path([(0.2, 0.0, 0.04), (0.215, 0.05, 0.05), (0.215, 0.4, 0.06), (0.21, 0.5, -0.01)], [0.04] * 4),
        limb((0, 0, 0.03), (0.06, 0, 0.03), 0.042),
        smooth=0.02,
    )
    frame = surface_net(mirrored(side), (-0.36, -0.16, -0.24), (0.36, 0.64, 0.24), cell, 8)
    return triangulated(frame).moved((0, -0.98, 1.79))


def hat(sides: int = 10) -> Shape:
    """A thick felt hat above the ogre's head, and narrower inside than the head."""
    profile = [
        (0.0, 0.3), (0.12, 0.3), (0.2, 0.25), (0.215, 0.12), (0.24, 0.02), (0.4, 0.0), (0.42, -0.03),
        (0.3, -0.05), (0.19, -0.05), (0.16, 0.18), (0.0, 0.22),
    ]  # fmt: skip
    return revolution(np.array(profile)[::-1], sides).moved((0, -0.02, 2.3))
