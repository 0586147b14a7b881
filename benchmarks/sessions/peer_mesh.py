# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for ipctk, which its documentation lets a user give less than everything.

everything  the whole mesh
filter      the vertices that move first, and `make_static_obstacle_filter`: pairs at rest are skipped
culled      the same, for the triangles that move and those that the bounding box of their motion meets
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Triangles = NDArray[np.int32]
SETTINGS = ("everything", "filter", "culled")


@dataclass(frozen=True)
class LinearStep:
    """Triangles (F, 3) over vertices that move from `start` to `end`, (N, 3) each."""

    triangles: Triangles
    start: Array
    end: Array

    @property
    def moves(self) -> NDArray[np.bool_]:
        """Whether each vertex moves, (N,)."""
        moving: NDArray[np.bool_] = (self.start != self.end).any(axis=1)
        return moving


def settings_of(step: LinearStep) -> tuple[str, ...]:
    """The settings that differ for a step. If every vertex moves, there is only one."""
    return SETTINGS[:1] if step.moves.all() else SETTINGS


def culled(step: LinearStep) -> LinearStep:
    """The moving triangles, and those whose box overlaps the box of their motion."""
    moving = step.moves[step.triangles].any(axis=1)
    if not moving.any():
        return LinearStep(step.triangles[:0], step.start, step.end)
    swept = np.concatenate([step.start[step.triangles[moving]], step.end[step.triangles[moving]]]).reshape(-1, 3)
    corners = step.start[step.triangles]
    near = ((corners.min(axis=1) <= swept.max(axis=0)) & (corners.max(axis=1) >= swept.min(axis=0))).all(axis=1)
    return LinearStep(step.triangles[moving | near], step.start, step.end)


def moving_first(step: LinearStep) -> LinearStep:
    """The step with only the vertices of triangles, moving vertices first."""
    used = np.unique(step.triangles)
    moves = step.moves[used]
    order = np.concatenate([used[moves], used[~moves]])
    place = np.zeros(len(step.start), np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    return LinearStep(place[step.triangles], step.start[order], step.end[order])


@dataclass(frozen=True)
class PeerMesh:
    """A step in the form of ipctk."""

    mesh: Any  #: ipctk.CollisionMesh
    start: Array  #: column-major
    end: Array


def peer_mesh(ipctk: ModuleType, step: LinearStep, setting: str) -> PeerMesh:
    """The mesh of a step in one of the settings."""
    if setting == "culled":
        step = culled(step)
    if setting != "everything":
        step = moving_first(step)
    triangles, start = np.asfortranarray(step.triangles), np.asfortranarray(step.start)
    mesh = ipctk.CollisionMesh(start, ipctk.edges(triangles), triangles)
    if setting != "everything":
        mesh.can_collide = ipctk.make_static_obstacle_filter(int(step.moves.sum()))
    return PeerMesh(mesh, start, np.asfortranarray(step.end))
