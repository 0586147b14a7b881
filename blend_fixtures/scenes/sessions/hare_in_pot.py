# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 9: a closed mesh scaled up inside a vessel until it is pressed against it everywhere."""

from __future__ import annotations

from functools import cache

import numpy as np

from ..colors import FUR, GLAZE
from ..fields import Field, ellipsoid, half_space, limb, merged, mirrored, path, ring, without
from ..fixture import Fixture, MeshObject, View, lattice_around
from ..motion import on_points, scale
from ..shape import Shape
from ..surface_nets import surface_net
from .lattice_stage import lattice_stage
from .session import Session, single

HARE_CELL, POT_CELL = 0.01146, 0.1
START = 1.3  # fraction of the hare's described size at which it barely does not touch the pot
GROWTH, SCALINGS = 1.5, 120


def hare() -> Field:
    """A sitting hare, about 1.2 long, with laid-back ears, paws and a tail; it looks along -y."""
    trunk = merged(
        ellipsoid((0, 0.16, -0.06), (0.33, 0.42, 0.33)), ellipsoid((0, -0.2, -0.04), (0.25, 0.3, 0.29)), smooth=0.15
    )
    head = merged(
        ellipsoid((0, -0.44, 0.2), (0.17, 0.2, 0.17)), ellipsoid((0, -0.58, 0.15), (0.1, 0.12, 0.1)), smooth=0.08
    )
    side = merged(
        path([(0.07, -0.4, 0.32), (0.11, -0.26, 0.45), (0.14, -0.04, 0.5)], [0.05, 0.068, 0.03]),
        ellipsoid((0.22, 0.2, -0.16), (0.15, 0.26, 0.2)),
        limb((0.23, 0.2, -0.34), (0.23, -0.12, -0.37), 0.085, 0.065),
        limb((0.13, -0.32, -0.12), (0.14, -0.43, -0.36), 0.085, 0.06),
        smooth=0.09,
    )
    tail = ellipsoid((0, 0.58, -0.08), (0.1, 0.1, 0.11))
    eye_hollow = ellipsoid((0.155, -0.52, 0.24), (0.035, 0.04, 0.035))
    return without(merged(trunk, head, mirrored(side), tail, smooth=0.09), mirrored(eye_hollow), smooth=0.03)


def pot() -> Field:
    """A teapot, about 2.9 wide, with handle, spout and a lid that closes its inside."""
    belly = without(ellipsoid((0, 0, -0.05), (1.26, 1.26, 1.08)), half_space(2, -0.98), smooth=0.15)
    lid = merged(ring((0, 0, 0.86), 2, 0.55, 0.1), ellipsoid((0, 0, 1.13), (0.17, 0.17, 0.15)), smooth=0.2)
    spout = path([(0, -1.05, -0.35), (0, -1.5, -0.05), (0, -1.74, 0.35), (0, -1.98, 0.62)], [0.36, 0.28, 0.24, 0.25])
    handle = path(
        [(0, 1.1, 0.42), (0, 1.52, 0.5), (0, 1.82, 0.3), (0, 1.8, -0.1), (0, 1.5, -0.42), (0, 1.1, -0.55)],
        [0.13, 0.125, 0.125, 0.125, 0.125, 0.14],
    )
    whole = merged(belly, lid, spout, handle, smooth=0.16)
    mouth = limb((0, -1.92, 0.55), (0, -2.2, 0.84), 0.07, 0.11)
    inside = without(ellipsoid((0, 0, -0.05), (1.03, 1.03, 0.83)), half_space(2, -0.78), smooth=0.12)
    return without(without(whole, mouth, smooth=0.05), inside)


@cache
def shapes() -> tuple[Shape, Shape]:
    """Hare and pot as quad meshes."""
    animal = surface_net(hare(), (-0.6, -0.9, -0.6), (0.6, 0.9, 0.7), HARE_CELL)
    vessel = surface_net(pot(), (-1.5, -2.4, -1.3), (1.5, 2.2, 1.5), POT_CELL)
    return _rounded(animal.scaled(START)), _rounded(vessel)


def _rounded(shape: Shape) -> Shape:
    """The shape with coordinates rounded to multiples of 2^-15 (0.2 % of the hare's edges), which halves the .blend."""
    return Shape(np.round(shape.vertices * 2**15) / 2**15, shape.faces)


def hare_in_pot() -> Fixture:
    """38,045 vertices and 75,943 triangles in the paper, equal within 1 %."""
    animal, vessel = shapes()
    low, high = animal.vertices.min(0) - 0.05, animal.vertices.max(0) + 0.05
    growth = GROWTH ** (1 / SCALINGS)
    factors = (growth, growth, growth)
    return Fixture(
        name="hare_in_pot",
        summary="A hare in a tri-cubic lattice scaled up inside a teapot until it is pressed against it everywhere",
        meshes=(MeshObject("Hare", animal, FUR, lattice="Lattice"), MeshObject("Pot", vessel, GLAZE)),
        lattices=(lattice_around("Lattice", tuple(low.tolist()), tuple(high.tolist()), (7, 8, 7)),),
        steps=(scale(on_points("Lattice"), factors, repeat=SCALINGS),),
        view=View((5.6, -4.2, 2.6), (0.0, 0.0, 0.0), lens=55.0),
    )


def session() -> Session:
    """The fixture's edits without Blender."""
    return Session("hare", 9, "A hare scaled up inside a teapot", single(lambda: lattice_stage(hare_in_pot())))
