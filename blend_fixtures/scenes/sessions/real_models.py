# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 9 and 1 with published models: an animal scaled up inside a teapot, and a dressed figure.

The models are shapes that stand upright along y, like in their files, and have no intersections.
"""

from __future__ import annotations

import numpy as np

import stiv

from ..ogre import glasses, hat, shirt
from ..shape import Shape
from . import dressing
from .hare_in_pot import GROWTH
from .session import Session, Stage, repeated, scaled, single, surface_of
from .subdivision_parts import Parts, part

SCALINGS = 60
ROOM = np.array(
    [0.0, 1.2, 0.0]
)  #: centre inside Newell's teapot, whose body has a radius of 1.5 to 2 and a height of 2.4
SMALLEST, STEP = 0.3, 1.04  #: the animal's first size, and the factor to the next one, until it touches the wall
MOST_STEPS, HALVINGS, CLEARANCE = 100, 14, 0.98
HEIGHT = 2.0
SLEEVES = ((0.2, 0.04, 1.3), (0.8, 0.02, 0.88))  #: along arms that hang
SHIRT_SIZE, SHIRT_PLACE = (0.86, 0.86, 1.0), (0.0, 0.06, 0.02)
HEAD_SHARE, GLASSES_PLACE, HAT_PLACE = 0.74, (0.0, -0.13, 0.44), (0.0, -0.03, 0.42)


def animal_in_teapot(animal: Shape, teapot: Shape) -> Session:
    """Figure 9: the animal in a tri-cubic lattice, scaled up, starting just before its first contact."""
    return Session("bunny", 9, "An animal scaled up inside a teapot", single(lambda: _teapot_stage(animal, teapot)))


def _teapot_stage(animal: Shape, teapot: Shape) -> Stage:
    low, high = animal.vertices.min(axis=0), animal.vertices.max(axis=0)
    unit = (animal.vertices - (low + high) / 2) / np.linalg.norm(high - low)

    def placed(size: float) -> Shape:
        return Shape((ROOM + size * unit).astype(np.float32).astype(float), animal.faces)

    def meets(size: float) -> bool:
        surface, start = surface_of({"Animal": placed(size), "Teapot": teapot})
        return len(stiv.find_intersections(start, surface)) > 0

    met = next(SMALLEST * STEP**k for k in range(MOST_STEPS) if meets(SMALLEST * STEP**k))
    free = met / STEP
    for _ in range(HALVINGS):
        middle = (free + met) / 2
        free, met = (free, middle) if meets(middle) else (middle, met)
    surface, start = surface_of({"Animal": placed(CLEARANCE * free), "Teapot": teapot}, {"Teapot": "fixed"})
    moves = np.flatnonzero(surface.vertex_body == 0)
    box = start[moves].min(axis=0) - 0.05, start[moves].max(axis=0) + 0.05
    resolution = (7, 8, 7)
    frame = np.diag([*(box[1] - box[0]) / (np.array(resolution) - 1), 1.0])
    frame[:3, 3] = (box[0] + box[1]) / 2
    weights = stiv.lattice(start[moves], resolution, frame=frame)
    points = stiv.lattice_rest_points(resolution) @ frame[:3, :3].T + frame[:3, 3]
    growth = repeated(scaled(GROWTH ** (1 / SCALINGS)), SCALINGS)
    return Stage("bunny", surface, stiv.concatenate([(weights, moves)], start), points, growth)


def upright(figure: Shape) -> Shape:
    """The figure rotated from y up to z up, facing -y, standing on z = 0, scaled to HEIGHT."""
    turned = figure.vertices[:, [0, 2, 1]] * (1.0, -1.0, 1.0)
    turned -= (0.0, 0.0, turned[:, 2].min())
    return Shape(HEIGHT / turned[:, 2].max() * turned, figure.faces)


def dressed_figure(figure: Shape) -> Session:
    """Figure 1: the session of our ogre with another figure, whose vertices are the controls."""
    return Session("ogre", 1, "A figure is dressed", lambda: dressing.stages(dressing_parts(figure)))


def dressing_parts(figure: Shape) -> Parts:
    """The figure, a shirt for hanging arms, and smaller glasses and hat."""
    clothes = {
        "Shirt": (shirt(sleeve_line=SLEEVES).scaled(SHIRT_SIZE).moved(SHIRT_PLACE), 2),
        "Glasses": (glasses().scaled(HEAD_SHARE).moved(GLASSES_PLACE), 1),
        "Hat": (hat().scaled(HEAD_SHARE).moved(HAT_PLACE), 2),
    }
    return Parts({"Ogre": part(upright(figure), 0), **{name: part(*worn) for name, worn in clothes.items()}})
