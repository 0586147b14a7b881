# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of an edit for the user."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stiv.blender.controls.control_set import ControlSet
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.guarded_evaluations import Guard


@dataclass(frozen=True)
class ParticipantSummary:
    """An object with a surface.

    Its role is "cage", "soft" (moved by handles), "lattice" (deformed by one), "rigid" or "obstacle".
    """

    name: str
    role: str
    triangles: int


@dataclass(frozen=True)
class Summary:
    """The participants, the number of hidden objects with a surface, and warnings.

    guard: the evaluations that stay free of intersections: "viewport", "render" or "both".
    """

    participants: tuple[ParticipantSummary, ...]
    hidden: int
    controls: int
    triangles: int
    guard: str
    warnings: tuple[str, ...]


def summarise(assembly: Assembly, control_sets: Sequence[ControlSet], hidden: int, guard: Guard) -> Summary:
    """Summarise an edit."""
    roles = {index: control_set.role for control_set in control_sets for index in control_set.surfaces}
    counts: dict[tuple[str, str], int] = {}
    for index, mesh in enumerate(assembly.meshes):
        key = (mesh.owner.name, roles.get(index, "obstacle"))
        counts[key] = counts.get(key, 0) + len(mesh.triangles)
    for static in assembly.obstacles:
        key = (static.owner.name, "obstacle")
        counts[key] = counts.get(key, 0) + static.triangle_count
    return Summary(
        tuple(ParticipantSummary(name, role, count) for (name, role), count in counts.items()),
        hidden,
        sum(len(each.controls) for each in control_sets),
        sum(counts.values()),
        guard.choice,
        (
            *((guard.reason,) if guard.reason else ()),
            *_warnings(assembly),
        ),
    )


def _warnings(assembly: Assembly) -> tuple[str, ...]:
    columns, corners = np.ascontiguousarray(assembly.positions.T), assembly.surface.triangles.T
    for i in range(3):  # the triangles left after it have a cross product of 0
        (a, b, c), (d, e, f) = ([columns[axis].take(corner) for corner in corners] for axis in (i - 2, i - 1))
        corners = corners[:, (b - a) * (f - d) == (e - d) * (c - a)]
    flat = corners.shape[1]
    counted = "1 triangle has" if flat == 1 else f"{flat:,} triangles have"
    return (f"{counted} no area",) if flat else ()
