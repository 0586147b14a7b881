# SPDX-License-Identifier: GPL-3.0-or-later
"""What an edit is about, in words and numbers for the user."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stiv.blender.controls.control_set import Part
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.guarded_evaluations import Guard


@dataclass(frozen=True)
class Participant:
    """An object that shows a surface.

    Role "cage", "soft" (moved by handles), "lattice" (deformed by one), "rigid" or "obstacle".
    """

    name: str
    role: str
    triangles: int


@dataclass(frozen=True)
class Summary:
    """Who takes part, how many objects with a surface are hidden and do not, and what the user ought to know.

    guard: what is kept free of intersections: "viewport", "render" or "both".
    """

    participants: tuple[Participant, ...]
    hidden: int
    controls: int
    triangles: int
    guard: str
    warnings: tuple[str, ...]


def summarise(assembly: Assembly, parts: Sequence[Part], hidden: int, guard: Guard) -> Summary:
    """Sum up an edit."""
    roles = {index: part.role for part in parts for index in part.surfaces}
    counts: dict[tuple[str, str], int] = {}
    for index, mesh in enumerate(assembly.meshes):
        key = (mesh.owner.name, roles.get(index, "obstacle"))
        counts[key] = counts.get(key, 0) + len(mesh.triangles)
    return Summary(
        tuple(Participant(name, role, count) for (name, role), count in counts.items()),
        hidden,
        sum(len(part.controls) for part in parts),
        len(assembly.surface.triangles),
        guard.choice,
        (*((guard.reason,) if guard.reason else ()), *(part.note for part in parts if part.note), *_warnings(assembly)),
    )


def _warnings(assembly: Assembly) -> tuple[str, ...]:
    a, b, c = (assembly.positions[assembly.surface.triangles[:, corner]] for corner in range(3))
    flat = int((np.cross(b - a, c - a) == 0).all(axis=1).sum())
    return (f"{flat} triangles without area take part",) if flat else ()
