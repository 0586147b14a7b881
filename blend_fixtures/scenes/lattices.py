# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures with lattices: each interpolation type, rotated, partly outside; and one before a subdivision."""

from __future__ import annotations

from .colors import MOVING, STILL
from .fixture import Fixture, LatticeObject, MeshObject, Placement, Subdivision, View
from .motion import move, on_points, scale
from .primitives import box, torus, triangulated
from .walls import slab, wavy_wall

INTERPOLATIONS = ("linear", "cardinal", "catmull_rom", "bspline")


def lattice_of_type(interpolation: str) -> Fixture:
    """A torus, partly outside a rotated lattice of one interpolation type, pressed onto a plate and scaled up."""
    lattice = LatticeObject(
        "Lattice",
        (4, 3, 5),
        Placement((0.0, 0.0, 0.65), (0.3, 0.2, 0.5), (0.6, 0.8, 0.3)),
        "KEY_" + interpolation.upper(),
    )
    lowest = range(24)  # the two lowest layers of 4 x 3 points
    return Fixture(
        name="lattice_" + interpolation,
        summary=f"A lattice of type {interpolation}, turned, with points of the shape outside it",
        meshes=(
            MeshObject(
                "Torus", triangulated(torus(36, 16, 0.9, 0.3)), MOVING, Placement((0.0, 0.0, 0.6)), lattice="Lattice"
            ),
            MeshObject("Plate", slab(), STILL, smooth=False),
        ),
        lattices=(lattice,),
        steps=(
            move(on_points("Lattice"), (0.05, 0.0, -0.2), repeat=3),
            move(on_points("Lattice", lowest), (0.0, 0.1, -0.2), repeat=2),
            scale(on_points("Lattice"), (1.1, 1.1, 1.2)),
        ),
        view=View((3.2, -4.2, 2.6), (0.0, 0.0, 0.4)),
    )


def lattice_then_subdivision() -> Fixture:
    """A cube in a lattice, then subdivided, pressed into a wavy wall through the lattice's points."""
    return Fixture(
        name="lattice_then_subdivision",
        summary="A Lattice modifier followed by a Subdivision Surface modifier, pressed into a wavy wall",
        meshes=(
            MeshObject(
                "Block",
                box(3, (1.4, 1.4, 1.4)),
                MOVING,
                Placement((0.0, 0.0, 1.0)),
                lattice="Lattice",
                subdivision=Subdivision(2),
            ),
            MeshObject("Wavy wall", wavy_wall(), STILL),
        ),
        lattices=(LatticeObject("Lattice", (4, 4, 4), Placement((0.0, 0.0, 1.0), (0.0, 0.1, 0.3), (0.6, 0.6, 0.6))),),
        steps=(move(on_points("Lattice"), (0.05, 0.0, -0.2), repeat=4), scale(on_points("Lattice"), (1.2, 1.2, 1.0))),
        view=View((3.6, -4.6, 3.0), (0.0, 0.0, 0.6)),
    )
