# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6: one push, four weightings of the response: a ball is pushed into a cushion, both subdivision surfaces."""

from __future__ import annotations

import numpy as np

from ..primitives import box as box_cage
from ..primitives import icosphere, triangulated
from .session import Array, Session, Stage, moved, repeated, single
from .subdivision_parts import Parts, part

PUSH, PUSHES = 0.9, 12
WEIGHTINGS = ("both", "cushion", "ball", "left half")


def parts() -> Parts:
    """A ball above a cushion."""
    cushion = triangulated(box_cage(5, (2.4, 2.4, 0.8)))
    return Parts({"Ball": part(icosphere(2, 0.55).moved((0.03, 0.02, 1.05)), 2), "Cushion": part(cushion, 2)})


def weights(scene: Parts, weighting: str) -> Array:
    """What gives way: both, one of them, or both but only to the left of x = 0."""
    ball, cushion = len(scene.cages["Ball"]), len(scene.cages["Cushion"])
    if weighting == "left half":
        left = np.concatenate([scene.cages["Ball"], scene.cages["Cushion"]])[:, 0] < 0
        left[:ball] = True
        return np.where(left, 1.0, 0.0)
    shares = {"both": (1.0, 1.0), "cushion": (0.0, 1.0), "ball": (1.0, 0.0)}[weighting]
    return np.repeat(shares, (ball, cushion))


def stage(weighting: str) -> Stage:
    """The ball pushed down, the cushion wanted where it is."""
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
    """One session a weighting."""
    return tuple(Session(f"push, {w}", 6, "One push", single(lambda w=w: stage(w))) for w in WEIGHTINGS)
