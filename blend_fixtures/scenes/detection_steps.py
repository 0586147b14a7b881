# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps for measuring detection: a surface without intersections, and the motion of its vertices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .primitives import box, grid, triangulated
from .shape import Shape, joined
from .shoots import Bunch, shoots
from .sweeps import trefoil
from .vase import vase

Array = NDArray[np.float64]


KNOT_MOTION = (0.08, 0.06, 0.02)


@dataclass(frozen=True)
class Step:
    """A linear step of one surface; every vertex may move."""

    name: str
    triangles: NDArray[np.int32]  #: (F, 3)
    start: Array  #: (N, 3) free of intersections
    end: Array  #: (N, 3)


def step(name: str, parts: list[Shape], ends: list[Array]) -> Step:
    """The step that moves each shape to its positions in `ends`."""
    whole = joined(parts)
    return Step(name, whole.triangles(), whole.vertices, np.concatenate(ends))


def rounded_box(cuts: int, bumps: float = 0.0, radius: float = 1.0) -> Shape:
    """A closed body of 12 cuts^2 triangles: a box inflated to a sphere, with hills and valleys of about
        `bumps` radii.

    Bodies with different `cuts` sample the same smooth surface.
    """
    cube = triangulated(box(cuts))
    equal_angles = np.tan(cube.vertices * (np.pi / 4))
    ball = equal_angles / np.linalg.norm(equal_angles, axis=1)[:, None]
    x, y, z = 5 * ball.T
    hills = np.sin(x + 1) * np.sin(y + 2) + np.sin(1.3 * z) * np.sin(x - y)
    return Shape(radius * ball * (1 + 0.5 * bumps * hills)[:, None], cube.faces)


def pressed_inside(
    fine: int = 76, coarse: int = 23, roughness: float = 0.02, gap: float = 0.0215, growth: float = 0.008
) -> Step:
    """75,660 triangles: a bumpy closed body grows against the inside of a coarser closed one from all sides.

    Hills of the body are higher than those of the shell by `roughness`: they touch it, and the valleys do not.
    """
    body = rounded_box(fine, 0.1 + roughness).turned((0.3, 0.2, 0.1))
    shell = rounded_box(coarse, 0.1, 1 + gap).turned((0.3, 0.2, 0.1))
    return step("pressed inside", [body, shell], [(1 + growth) * body.vertices, shell.vertices])


def shoots_in_vase(squeeze: float = 0.925, growth: float = 0.04) -> Step:
    """27,270 triangles: shoots in a vase spread against its neck and lip."""
    bunch = shoots(Bunch(count=115)).scaled((squeeze, squeeze, 1)).moved((0, 0, 0.9))
    pot = vase(112, 55)
    return step("shoots in a vase", [bunch, pot], [bunch.scaled((1 + growth, 1 + growth, 1)).vertices, pot.vertices])


def _leaves(side: int, size: float, chance: np.random.Generator) -> Shape:
    """`side`^3 loose triangles in a box from -1 to 1, each in its own cell, so that none intersect."""
    centres = (np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), 3).reshape(-1, 3) + 0.5) / side * 2 - 1
    directions = chance.normal(size=(len(centres), 3, 3))
    directions /= np.linalg.norm(directions, axis=2)[:, :, None]
    vertices = centres[:, None] + size / side * directions
    return Shape(vertices.reshape(-1, 3), tuple((i, i + 1, i + 2) for i in range(0, 3 * len(centres), 3)))


def soup_in_corner(
    side: int = 25, cells: int = 23, size: float = 0.95, gap: float = 0.008, motion: float = 0.028
) -> Step:
    """18,799 triangles: a crown of loose leaves pressed into a corner of three walls, squeezed toward it."""
    crown = _leaves(side, size, np.random.default_rng(3))
    wall = triangulated(grid(cells, cells, 2.0, 2.0).moved((0.01, 0.01, 0)))
    reach = 1 + gap
    turns = ((0, 0, 0), (np.pi / 2, 0, 0), (0, np.pi / 2, 0))
    places = ((0, 0, -reach), (0, reach, 0), (-reach, 0, 0))
    walls = [wall.turned(turn).moved(place) for turn, place in zip(turns, places, strict=True)]
    away = np.linalg.norm(crown.vertices - (-1, 1, -1), axis=1)[:, None]
    end = crown.vertices + motion * (0.8 + 0.1 * away) * (-1, 1, -1)
    return step("soup in a corner", [crown, *walls], [end, *(w.vertices for w in walls)])


def knot(rings: int = 264, sides: int = 22, squeeze: float = 0.155) -> Step:
    """11,616 triangles: a knotted tube moves while its centre line is squeezed, so that strands barely touch."""
    shape = triangulated(trefoil(rings, sides))
    height = shape.vertices[:, 2].reshape(rings, sides).mean(axis=1)
    fall = np.zeros_like(shape.vertices)
    fall[:, 2] = np.repeat(squeeze * height, sides)
    return step("knot", [shape], [shape.vertices - fall + KNOT_MOTION])


def shell_onto_body(shrink: float = 0.0245) -> Step:
    """21,824 triangles: an open shell shrunk onto a bumpy body."""
    body = rounded_box(36, 0.1)
    round_about = triangulated(grid(56, 56, 2 * np.pi * 0.9, np.pi / 2)).vertices
    azimuth, height = round_about[:, 0], round_about[:, 1]
    ball = np.stack([np.cos(azimuth) * np.cos(height), np.sin(azimuth) * np.cos(height), np.sin(height)], axis=1)
    shell = Shape(1.1 * ball, triangulated(grid(56, 56)).faces)
    return step("shell onto a body", [body, shell], [body.vertices, (1 - shrink) * shell.vertices])


def local_edit(share: float = 0.02) -> Step:
    """`pressed_inside`, where only the fraction `share` of all vertices, nearest to one point of the body, moves."""
    whole = pressed_inside()
    distance = np.linalg.norm(whole.start - whole.start[0], axis=1)
    moves = distance <= np.sort(distance)[int(share * len(distance))]
    return Step("local edit", whole.triangles, whole.start, np.where(moves[:, None], whole.end, whole.start))


def flat_panel(cells: int = 388, stretch: float = 5e-4) -> Step:
    """301,088 triangles in one plane, slightly stretched in it: no contacts, and every cubic vanishes."""
    panel = triangulated(grid(cells, cells))
    return step("flat panel", [panel], [panel.vertices * (1 + stretch, 1 + stretch, 1)])


def growing(cuts: int) -> Step:
    """24 cuts^2 triangles: a body grows against the inside of an equally fine shell, on a quarter of its
        surface.

    Gap and step scale with the edge length, so candidates and hits per triangle do not depend on the resolution.
    """
    edge = np.pi / 2 / cuts
    body = rounded_box(cuts).turned((0.3, 0.2, 0.1))
    shell = rounded_box(cuts, 0, 1 + edge).turned((0.31, 0.19, 0.13)).moved((0, 0, 0.8 * edge))
    return step(f"growing {cuts}", [body, shell], [(1 + 0.4 * edge) * body.vertices, shell.vertices])


STEPS: Mapping[str, Callable[[], Step]] = {
    "pressed": pressed_inside,
    "vase": shoots_in_vase,
    "soup": soup_in_corner,
    "knot": knot,
    "shell": shell_onto_body,
    "local": local_edit,
    "panel": flat_panel,
}
