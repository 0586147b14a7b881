# SPDX-License-Identifier: GPL-3.0-or-later
"""A bunch of grass-like shoots: thin closed tubes of varying length, bend and radius that do not touch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .shape import Shape, joined
from .sweeps import tube

Array = NDArray[np.float64]

CLEARANCE = 3.2  # between centre lines, in radii: two for the tubes, one for the loss by fanning and chords
ATTEMPTS = 200


@dataclass(frozen=True)
class Bunch:
    """Parameters of the bunch; lengths in world units."""

    count: int = 183
    spacing: float = 0.062  # between neighbours at the foot
    height: float = 2.8
    spread: float = 1.7  # widening of the bunch from foot to tips
    droop: float = 0.85  # how far the outermost tips hang down
    sway: float = 2.4  # sideways bend of a tip before fanning, in spacings
    radius: float = 0.0155
    rings: int = 13
    sides: int = 5
    seed: int = 8


def feet(count: int, spacing: float) -> Array:
    """The `count` points (count, 2) of a hexagonal grid nearest to its centre."""
    reach = int(np.sqrt(count)) + 2
    i, j = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1), indexing="ij")
    points = spacing * np.stack([i + j / 2, j * np.sqrt(0.75)], 2).reshape(-1, 2)
    # An asymmetric offset makes all distances different, so the order is the same on any machine.
    order = np.argsort(np.linalg.norm(points - spacing * np.array([0.137, 0.071]), axis=1), kind="stable")
    return points[order[:count]]


def paths(bunch: Bunch) -> Array:
    """Centre lines (count, rings, 3) with the foot at z = 0, each swaying in the space between its neighbours."""
    chance = np.random.default_rng(bunch.seed)
    base = feet(bunch.count, bunch.spacing)
    height = np.linspace(0, 1, bunch.rings)
    accepted = np.empty((0, bunch.rings, 2))
    clearance = CLEARANCE * bunch.radius
    for foot in base:
        accepted = np.concatenate([accepted, _free_line(chance, foot, height, accepted, bunch, clearance)[None]])
    length = chance.uniform(0.5, 1.0, bunch.count)
    return np.stack([_fanned(line, height, share, bunch) for line, share in zip(accepted, length, strict=True)])


def _free_line(
    chance: np.random.Generator, foot: Array, height: Array, others: Array, bunch: Bunch, clearance: float
) -> Array:
    """A line (rings, 2) from `foot` with `clearance` from `others` at every height, or the best one if none has it."""
    best, room = np.tile(foot, (len(height), 1)), -1.0
    for attempt in range(ATTEMPTS):
        line = foot + _sway(chance, height, bunch.spacing * bunch.sway * (1 - attempt / ATTEMPTS))
        distance = np.linalg.norm(others - line, axis=2).min() if len(others) else np.inf
        if distance > room:
            best, room = line, distance
        if room > clearance:
            break
    return best


def _sway(chance: np.random.Generator, height: Array, size: float) -> Array:
    """A sideways bend (rings, 2) that grows upward from zero, plus one slow wave."""
    direction, phase = chance.uniform(0, 2 * np.pi, 2)
    bend = size * chance.uniform(0.2, 1.0) * height**1.7
    wave = 0.25 * size * height * np.sin(4.2 * height + phase)
    along = np.array([np.cos(direction), np.sin(direction)])
    return np.outer(bend, along) + np.outer(wave, [-along[1], along[0]])


def _fanned(line: Array, height: Array, share: float, bunch: Bunch) -> Array:
    """The line widened with height, with hanging outer shoots: a smooth map of space, so nothing intersects."""
    at = np.linspace(0, share, len(height))
    plane = np.stack([np.interp(at, height, line[:, axis]) for axis in range(2)], 1)
    outer = np.linalg.norm(plane, axis=1) / (bunch.spacing * np.sqrt(bunch.count / 3.6))
    wide = plane * (1 + bunch.spread * at**1.6)[:, None]
    return np.column_stack([wide, bunch.height * at - bunch.droop * outer**2 * at**2.4])


def radii(bunch: Bunch, thickness: float) -> Array:
    """Radius along a shoot (rings,): slender foot, thickest at a third, fine tip."""
    along = np.linspace(0, 1, bunch.rings)
    return (
        bunch.radius * thickness * (0.75 + 0.25 * np.sin(np.pi * np.minimum(along * 1.5, 1))) * (1 - 0.82 * along**2.2)
    )


def shoots(bunch: Bunch = Bunch()) -> Shape:
    """The bunch standing on z = 0 around the z axis: count (rings x sides + 2) vertices."""
    thickness = np.random.default_rng(bunch.seed + 1).uniform(0.75, 1.05, bunch.count)
    lines = paths(bunch)
    return joined([tube(line, radii(bunch, t), bunch.sides) for line, t in zip(lines, thickness, strict=True)])
