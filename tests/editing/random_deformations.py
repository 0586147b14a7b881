# SPDX-License-Identifier: GPL-3.0-or-later
"""Random sessions with any deformation, goals, weights, separations and responders."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes import families
from blend_fixtures.scenes.families import Edit
from blend_fixtures.scenes.primitives import box, grid, icosphere, triangulated

Array = NDArray[np.float64]
Chance = np.random.Generator


@dataclass(frozen=True)
class Case:
    """A session and its goals."""

    name: str
    edit: Edit  #: its surface, deformation and start
    options: stiv.EditOptions
    goals: list[tuple[str, Array]]  #: "edit", "drag" or "settle", and the goal (m, 3)


def side_by_side() -> Edit:
    """A rigid box, a subdivided cage, a sheet with handles and free vertices, above a fixed wall."""
    rigid = triangulated(box(1, (0.5, 0.4, 0.3))).turned((0.3, 0.2, 0.1)).moved((-0.8, -0.7, 0.6))
    cage = box(1, (0.6, 0.6, 0.6))
    fine = stiv.catmull_clark(stiv.Cage.of_faces(cage.faces), 2)
    cage = cage.moved((0.7, -0.7, 0.7))
    deformation, triangles = fine
    sheet = triangulated(grid(6, 6, 1.2, 1.2)).moved((-0.7, 0.7, 0.5))
    handles = np.array([24, 17, 31, 8])
    ball = icosphere(1).scaled(0.4).moved((0.8, 0.8, 0.7))
    wall = triangulated(grid(8, 8, 4, 4))
    surface_of_cage = deformation.surface(cage.vertices)
    parts = [rigid.vertices, surface_of_cage, sheet.vertices, ball.vertices, wall.vertices]
    begin = np.concatenate([[0], np.cumsum([len(part) for part in parts])])
    start = np.concatenate(parts)
    faces = [rigid.triangles(), triangles, sheet.triangles(), ball.triangles(), wall.triangles()]
    rows = [np.arange(begin[k], begin[k + 1]) for k in range(5)]
    whole = stiv.concatenate(
        [
            (stiv.rigid(rigid.vertices), rows[0]),
            (deformation, rows[1]),
            (stiv.laplacian(sheet.vertices, sheet.triangles(), handles), rows[2]),
            (stiv.identity(len(ball.vertices)), rows[3]),
        ],
        start,
    )
    kinds = ["rigid", "deformable", "deformable", "deformable", "fixed"]
    surface = stiv.Surface(
        np.concatenate([part + shift for part, shift in zip(faces, begin, strict=False)]),
        len(start),
        vertex_body=np.repeat(np.arange(5), [len(part) for part in parts]),
        bodies=[stiv.Body(f"{kind} {number}", kind) for number, kind in enumerate(kinds)],
    )
    controls = np.concatenate(
        [stiv.rigid_rest_controls(rigid.vertices), cage.vertices, sheet.vertices[handles], ball.vertices]
    )
    return Edit("side by side", surface, whole, controls, controls)


BUILDERS: list[Callable[[], Edit]] = [
    lambda: families.spheres(0.5, levels=1),
    lambda: families.sheets(0.5, cells=6),
    families.fold,
    lambda: families.subdivision(0.6, levels=1),
    lambda: families.loop(0.6),
    lambda: families.loop_by_handles(0.6),
    lambda: families.vase(1.5, count=3),
    lambda: families.rigid(0.7),
    lambda: families.knot(0.5, rings=48, sides=5),
    lambda: families.bulge(0.8, cells=8),
    lambda: families.bulge(0.8, cells=6, rigid=True),
    side_by_side,
]


def _goal(
    chance: Chance, controls: Array, selected: NDArray[np.bool_], turning: NDArray[np.bool_], size: float
) -> Array:
    """Selected points moved, rotated or scaled about their centre, sometimes with noise."""
    goal = controls.copy()
    points = selected & ~turning
    if points.any():
        middle = goal[points].mean(axis=0)
        arms = goal[points] - middle
        kind = chance.choice(["move", "move", "scale", "rotate"])
        if kind == "scale":
            arms = arms * chance.uniform(0.6, 1.5, 3)
        if kind == "rotate":
            arms = _rotated(chance.normal(scale=0.4, size=3), arms)
        push = chance.normal(size=3)
        push[2] -= 1.0  # downward, so that contacts occur
        goal[points] = middle + arms + chance.uniform(0, 0.5) * size * push / np.linalg.norm(push)
        if chance.random() < 0.3:
            goal[points] += chance.normal(scale=0.02 * size, size=(int(points.sum()), 3))
    turned = selected & turning
    goal[turned] += chance.normal(scale=0.4, size=(int(turned.sum()), 3))
    return goal


def _rotated(turn: Array, vectors: Array) -> Array:
    """Vectors turned by a rotation vector (Rodrigues' formula)."""
    angle = float(np.linalg.norm(turn))
    axis = turn / angle
    along = (vectors @ axis)[:, None] * axis
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors)


def _weights(chance: Chance, selected: NDArray[np.bool_]) -> Array | None:
    """Weights of the response: all, selected, unselected, or uneven."""
    who = chance.choice(["all", "all", "selected", "unselected", "weighted", "by axis"])
    if who == "all":
        return None
    if who == "by axis":
        return chance.choice([0.0, 0.3, 1.0, 2.0], size=(len(selected), 3))
    if who == "weighted":
        return chance.choice([0.0, 0.3, 1.0, 2.0], size=len(selected))
    return np.where(selected == (who == "selected"), 1.0, 0.0)


def as_stored(edit: Edit) -> Edit:
    """The same with controls in single precision, like those of a scene."""
    return replace(edit, controls=edit.controls.astype(np.float32).astype(float))


def random_cases(count: int, seed: int) -> Iterator[Case]:
    """Sessions with four goals each, `count` goals in total, cycling through all deformations."""
    chance = np.random.default_rng(seed)
    scenes = [as_stored(build()) for build in BUILDERS]
    for number in range(0, count, 4):
        edit = scenes[number // 4 % len(scenes)]
        start = edit.deformation.surface(edit.controls)
        size = float(np.linalg.norm(np.ptp(start[edit.surface.vertex_body == 0], axis=0)))
        turning = np.zeros(len(edit.controls), bool)
        if edit.surface.bodies[0].mobility == "rigid":
            turning[1] = True
        selected = chance.random(len(edit.controls)) < chance.choice([0.2, 0.6, 1.0])
        if edit.name == "side by side" and chance.random() < 0.7:  # one component, as a user would
            borders = np.cumsum([0, 2, 8, 4, 42])
            part = chance.integers(4)
            selected = (np.arange(len(selected)) >= borders[part]) & (np.arange(len(selected)) < borders[part + 1])
        separation = 0.0 if chance.random() < 0.5 else float(size * 10 ** chance.uniform(-4, -2))
        several = len(edit.surface.bodies) > 1 and chance.random() < 0.3
        pairs = {(0, 1): float(size * 10 ** chance.uniform(-3.5, -2))} if several else {}
        options = stiv.EditOptions(
            separation=separation,
            pair_separations=pairs,
            weights=_weights(chance, selected),
            smoothness=float(chance.choice([0.1, 0.01])),
            constraints=str(chance.choice(["per_patch", "per_patch", "single"])),
        )
        goals = []
        for _ in range(4):
            how = str(chance.choice(["edit", "edit", "drag", "settle"]))
            goals.append((how, _goal(chance, edit.controls, selected, turning, size)))
        yield Case(f"{number // 4}: {edit.name}", edit, options, goals)
