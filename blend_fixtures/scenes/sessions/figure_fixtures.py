# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's figures as large fixtures, written as .blend files in a separate folder."""

from __future__ import annotations

import numpy as np

from ..colors import GLAZE, MOVING, ORGANS, SKIN
from ..fixture import Fixture, MeshObject, Subdivision, VertexGroup, View
from ..motion import move, on_objects, on_points, repair
from ..shape import Shape
from ..tangled import arm_in_body
from . import knot, packing
from .dressing import dressing
from .face_into_waves import face_into_waves
from .hare_in_pot import hare_in_pot
from .tree_in_corner import tree_in_corner
from .weighted_handles import weighted_handles


def knot_by_handles() -> Fixture:
    """The knot under Laplacian editing: its top arch is dragged, and weights pin its bottom."""
    tube = knot.shape()
    height = tube.vertices[:, 1]
    arch = np.flatnonzero(height > np.quantile(height, 0.9)).tolist()
    free = np.flatnonzero(height >= np.quantile(height, 0.12)).tolist()
    half = knot.MOVES // 2
    up, aside = (0.0, knot.LIFT / half, 0.0), (knot.ASIDE / half, 0.0, knot.ASIDE / half)
    groups = (VertexGroup("Arch", dict.fromkeys(arch, 1.0)), VertexGroup("Weights", dict.fromkeys(free, 1.0)))
    return Fixture(
        name="knot_by_handles",
        summary="A knot under Laplacian editing: its bottom is pinned, its top arch is dragged up and aside",
        meshes=(MeshObject("Knot", tube, MOVING, groups=groups),),
        steps=(move(on_points("Knot", arch), up, repeat=half), move(on_points("Knot", arch), aside, repeat=half)),
        view=View((0.5, -1.0, 15.0), (0.1, 0.3, 0.0)),
        settings={"objects": {"Knot": {"deformation": "laplacian", "handles": ["Arch"], "weight_group": "Weights"}}},
    )


def untangling() -> Fixture:
    """A figure whose arm was bent into its body and leg, for repair."""
    tangle = arm_in_body()
    shape = Shape(tangle.positions, tuple(map(tuple, tangle.surface.triangles.tolist())))
    return Fixture(
        name="untangling",
        summary="An arm bent into its own body and leg, and repaired",
        meshes=(MeshObject("Figure", shape, SKIN),),
        steps=(repair(on_objects(["Figure"])),),
        view=View((2.4, -16.0, 3.4), (0.0, 0.0, 1.2), 45.0),
    )


def organs_in_bowl() -> Fixture:
    """The nine organs, lowered one after another."""
    scene = packing.parts()
    colors = {material.name: material for material in ORGANS}
    names = [name for name in scene.parts if name != "Bowl"]
    meshes = [MeshObject(n, scene.parts[n].cage, colors[n], subdivision=Subdivision(1)) for n in names]
    bowl = MeshObject("Bowl", scene.parts["Bowl"].cage, GLAZE)
    moves = 12
    ways = {n: np.subtract(packing.PLACES[n][1], packing.PLACES[n][0]) / moves for n in names}
    return Fixture(
        name="organs_in_bowl",
        summary="Nine soft organs, subdivision surfaces, packed into a bowl",
        meshes=(*meshes, bowl),
        steps=tuple(move(on_points(name), ways[name].tolist(), repeat=moves) for name in packing.PLACES),
        view=View((3.2, -6.6, 3.6), (0.0, 0.0, 1.0), lens=48.0),
    )


def figure_fixtures() -> tuple[Fixture, ...]:
    """All large fixtures in the order of the paper's figures; Figure 8 is the fixture `plant_in_vase`."""
    return (
        dressing(),
        organs_in_bowl(),
        untangling(),
        weighted_handles(),
        face_into_waves(),
        hare_in_pot(),
        tree_in_corner(),
        knot_by_handles(),
    )
