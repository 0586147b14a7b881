# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures in which an object is pressed into or along another."""

from __future__ import annotations

import numpy as np

from .colors import MOVING, SECOND, STILL
from .fixture import EmptyObject, Fixture, MeshObject, Modifier, Placement, Subdivision, View
from .motion import move, on_objects, on_points, rotate
from .primitives import box, grid, icosphere, triangulated
from .shape import Shape
from .walls import slab, wavy_wall


def cage_into_wavy_wall() -> Fixture:
    """A subdivided cube whose cage is pressed into a wavy wall, first its lower side, then the whole cage."""
    cage = box(2, (2.0, 2.0, 2.0))
    lower = np.flatnonzero(cage.vertices[:, 2] < -0.5)
    return Fixture(
        name="cage_into_wavy_wall",
        summary="A subdivision cage pressed into a wavy wall in Edit Mode",
        meshes=(
            MeshObject("Cage", cage, MOVING, Placement((0.0, 0.0, 1.3)), subdivision=Subdivision(3)),
            MeshObject("Wavy wall", wavy_wall(), STILL),
        ),
        steps=(
            move(on_points("Cage", lower.tolist()), (0.05, 0.0, -0.4)),
            move(on_points("Cage"), (0.05, 0.0, -0.3), repeat=3),
        ),
        view=View((4.2, -5.2, 3.4), (0.0, 0.0, 0.5)),
    )


def plate_with_modifiers() -> Fixture:
    """Half of a curved plate that is mirrored, thick and bevelled, pressed onto a ball."""
    half = grid(3, 5, 1.1, 2.0).moved((0.55, 0.0, 0.0))
    x, y, _ = half.vertices.T
    bent = np.column_stack([x, y, 0.25 * x**2 - 0.1 * y**2])
    modifiers = (
        Modifier("MIRROR", "Mirror"),
        Modifier("SOLIDIFY", "Solidify", {"thickness": 0.12}),
        Modifier("BEVEL", "Bevel", {"width": 0.03, "segments": 1, "limit_method": "NONE"}),
    )
    return Fixture(
        name="plate_with_modifiers",
        summary="A mirrored, thick and bevelled plate pressed onto a ball in Edit Mode",
        meshes=(
            MeshObject("Plate", Shape(bent, half.faces), MOVING, Placement((0.0, 0.0, 1.15)), modifiers=modifiers),
            MeshObject("Ball", icosphere(3, 0.8), STILL),
        ),
        steps=(move(on_points("Plate"), (0.0, 0.05, -0.15), repeat=5),),
        view=View((3.4, -4.4, 2.6), (0.0, 0.0, 0.5)),
    )


def sheet_through_sheet() -> Fixture:
    """A small sheet pushed fully through a larger one in a single edit; both can yield if selected."""
    small = triangulated(grid(15, 15, 0.6, 0.6)).turned((0.0, 0.0, 0.2))
    bumpy = small.vertices + np.column_stack(
        [np.zeros((len(small.vertices), 2)), 0.05 * np.sin(5 * small.vertices[:, 0])]
    )
    return Fixture(
        name="sheet_through_sheet",
        summary="A sheet pushed fully through another in one edit",
        meshes=(
            MeshObject("Upper sheet", Shape(bumpy, small.faces), MOVING, Placement((0.03, 0.02, 0.2))),
            MeshObject("Lower sheet", triangulated(grid(15, 15)), STILL),
        ),
        steps=(move(on_points("Upper sheet"), (0.0, 0.0, -1.0)),),
        view=View((1.3, -1.7, 0.9), (0.0, 0.0, 0.05)),
    )


def box_along_wall() -> Fixture:
    """A rigid box dragged along a wall and into it, then away again."""
    selected = on_objects(["Box"])
    return Fixture(
        name="box_along_wall",
        summary="A rigid box dragged along a wall, and away from it",
        meshes=(
            MeshObject("Box", box(3, (0.5, 0.5, 0.5)), MOVING, Placement((-1.0, 0.0, 0.3)), smooth=False),
            MeshObject("Wall", slab(), STILL, smooth=False),
        ),
        steps=(move(selected, (0.2, 0.0, -0.2), repeat=10), move(selected, (-0.1, 0.0, 0.2), repeat=4)),
        view=View((2.6, -4.4, 2.2), (0.0, 0.0, 0.2)),
    )


def sphere_along_wall() -> Fixture:
    """A rigid faceted sphere dragged along a wall and into it, then away again."""
    selected = on_objects(["Sphere"])
    return Fixture(
        name="sphere_along_wall",
        summary="A rigid faceted sphere dragged along a wall, and away from it",
        meshes=(
            MeshObject("Sphere", icosphere(3, 0.3), MOVING, Placement((-1.0, 0.0, 0.35)), smooth=False),
            MeshObject("Wall", slab(), STILL, smooth=False),
        ),
        steps=(move(selected, (0.2, 0.05, -0.2), repeat=10), move(selected, (-0.1, 0.0, 0.2), repeat=4)),
        view=View((2.6, -4.4, 2.2), (0.0, 0.0, 0.2)),
    )


def rigid_ellipsoid() -> Fixture:
    """An ellipsoid with negative, non-uniform scale under a rotated and scaled parent, pushed and rotated on
    a plate.
    """
    selected = on_objects(["Ellipsoid"])
    return Fixture(
        name="rigid_ellipsoid",
        summary="A rigid ellipsoid with a parent and negative scale pushed against a plate",
        meshes=(
            MeshObject(
                "Ellipsoid",
                icosphere(3),
                MOVING,
                Placement((0.1, 0.0, 0.5), (0.1, 0.5, 0.2), (-0.8, 0.4, 0.25)),
                "Parent",
            ),
            MeshObject("Plate", slab(5.0), STILL, smooth=False),
        ),
        empties=(EmptyObject("Parent", Placement((0.0, 0.1, 0.2), (0.0, 0.0, 0.6), (1.2, 1.2, 1.2))),),
        steps=(
            move(selected, (0.1, 0.0, -0.3), repeat=4),
            rotate(selected, 0.6, (0.0, 1.0, 0.0)),
            move(selected, (0.0, 0.2, 0.3)),
        ),
        view=View((3.0, -4.2, 2.4), (0.0, 0.0, 0.4)),
        settings={"object_response": "slide_and_turn"},
    )


def coplanar_plates() -> Fixture:
    """Three flat plates, all exactly in the plane z = 0, slid toward and along each other."""
    first, second = on_objects(["First plate"]), on_objects(["Second plate"])
    plate = grid(4, 4, 0.8, 0.8)
    return Fixture(
        name="coplanar_plates",
        summary="Coplanar plates at z = 0 slid toward and along each other",
        meshes=(
            MeshObject("First plate", plate, MOVING, Placement((-1.0, 0.1, 0.0)), smooth=False),
            MeshObject("Second plate", plate, SECOND, Placement((0.0, 0.0, 0.0), (0.0, 0.0, 0.3)), smooth=False),
            MeshObject("Third plate", triangulated(plate), STILL, Placement((1.1, 0.0, 0.0)), smooth=False),
        ),
        steps=(
            move(first, (0.3, 0.0, 0.0), repeat=3),
            move(first, (0.0, 0.2, 0.0)),
            move(second, (0.4, 0.1, 0.0), repeat=2),
        ),
        view=View((0.2, -3.0, 3.8), (0.05, 0.0, 0.0), lens=46.0),
    )
