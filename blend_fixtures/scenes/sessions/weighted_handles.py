# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6: a ball is pushed into a cushion with four weightings of the response; both are subdivision surfaces."""

from __future__ import annotations

import numpy as np

from ..colors import MOVING, STILL
from ..fixture import Fixture, MeshObject, VertexGroup, View
from ..motion import Step, move, on_objects
from ..primitives import box as box_cage
from ..primitives import icosphere, triangulated
from ..shape import Shape
from .session import Array, Session, Stage, moved, repeated, single
from .subdivision_parts import Parts, part

PUSH, PUSHES = 0.9, 12
WEIGHTINGS = ("both", "cushion", "ball", "left half")
RESPONDERS = {"both": "all", "cushion": "unselected", "ball": "selected", "left half": "all"}
APART = 3.0


def cages() -> tuple[Shape, Shape]:
    """A ball above a cushion."""
    return icosphere(2, 0.55).moved((0.03, 0.02, 1.05)), triangulated(box_cage(5, (2.4, 2.4, 0.8)))


def parts() -> Parts:
    """Both surfaces, subdivided."""
    ball, cushion = cages()
    return Parts({"Ball": part(ball, 2), "Cushion": part(cushion, 2)})


def weights(scene: Parts, weighting: str) -> Array:
    """Response weights: both yield, one of them, or both but only to the left of x = 0."""
    ball, cushion = len(scene.cages["Ball"]), len(scene.cages["Cushion"])
    if weighting == "left half":
        left = np.concatenate([scene.cages["Ball"], scene.cages["Cushion"]])[:, 0] < 0
        left[:ball] = True
        return np.where(left, 1.0, 0.0)
    shares = {"both": (1.0, 1.0), "cushion": (0.0, 1.0), "ball": (1.0, 0.0)}[weighting]
    return np.repeat(shares, (ball, cushion))


def stage(weighting: str) -> Stage:
    """The ball pushed down; the goal of the cushion is its current position."""
    scene = parts()
    both = ("Ball", "Cushion")
    push = moved((0, 0, -PUSH / PUSHES), scene.block(both, "Ball"))
    plain = scene.by_cages(weighting, both, repeated(push, PUSHES))
    return Stage(
        plain.name,
        plain.surface,
        plain.deformation,
        plain.controls,
        plain.edits,
        {"weights": weights(scene, weighting)},
    )


def sessions() -> tuple[Session, ...]:
    """One session per weighting."""
    return tuple(Session(f"push, {w}", 6, "One push", single(lambda w=w: stage(w))) for w in WEIGHTINGS)


def weighted_handles() -> Fixture:
    """All four side by side, in the order of WEIGHTINGS; each push affects only its own pair."""
    ball, cushion = cages()
    left = VertexGroup("Left", dict.fromkeys(np.flatnonzero(cushion.vertices[:, 0] < 0).tolist(), 1.0))
    meshes, names = [], {weighting: (f"Ball, {weighting}", f"Cushion, {weighting}") for weighting in WEIGHTINGS}
    for number, (first, second) in enumerate(names.values()):
        place = (APART * (number - 1.5), 0.0, 0.0)
        meshes.append(MeshObject(first, ball.moved(place), MOVING, loop=2))
        meshes.append(MeshObject(second, cushion.moved(place), STILL, loop=2, groups=(left,)))
    objects = {name: {"deformation": "vertices"} for pair in names.values() for name in pair}
    objects[names["left half"][1]]["weight_group"] = "Left"

    def push(weighting: str) -> Step:
        participants = names[weighting]
        roles = {mesh.name: "auto" if mesh.name in participants else "obstacle" for mesh in meshes}
        step = move(on_objects([participants[0]]), (0.0, 0.0, -PUSH / PUSHES), repeat=PUSHES)
        return {**step, "settings": {"responders": RESPONDERS[weighting], "roles": roles}}

    return Fixture(
        name="weighted_handles",
        summary="One push, four weightings: both yield, the cushion, the ball, the ball and the cushion's left half",
        meshes=tuple(meshes),
        steps=tuple(push(weighting) for weighting in WEIGHTINGS),
        view=View((2.0, -13.5, 6.0), (0.0, 0.0, 0.1), 36.0, (1000, 400)),
        settings={"objects": objects},
    )
