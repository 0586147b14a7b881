# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the session of the last edit for the next one, if nothing but its accepted controls changed since."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace
from typing import Any

import numpy as np

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.deformation_cache import clear_cache
from stiv.blender.scene.arrays import Floats, diagonal_of, digest
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.shared_surface import are_equal
from stiv.blender.scene.static_mesh import StaticMesh
from stiv.blender.scene.static_reading import forget_static_meshes

LARGEST_GROWTH = 1.1  # of the moving surface, either way; the automatic separation is a part of its diagonal


@dataclass(frozen=True)
class SessionInputs:
    """All that a session is made from, except its controls.

    surface: with its connectivity and its bodies.
    fingerprint: of the options and the positions of all vertices that no control moves.
    deformations: of the control sets; equal ones are the same objects, because they are cached by their inputs.
    diagonal: of the moving vertices.
    obstacles: equal ones are the same objects, because their reading is cached.
    """

    surface: stiv.Surface
    fingerprint: bytes
    deformations: tuple[stiv.Deformation, ...]
    diagonal: float
    options: stiv.EditOptions
    obstacles: tuple[StaticMesh, ...]

    @classmethod
    def of(cls, assembly: Assembly, control_sets: Sequence[ControlSet], options: stiv.EditOptions) -> SessionInputs:
        """The inputs of a session of these control sets."""
        positions, moving = assembly.positions, np.zeros(len(assembly.positions), bool)
        vertices = assembly.vertices_of([index for each in control_sets for index in each.surfaces])
        moving[vertices] = True
        diagonal = diagonal_of(positions.take(vertices, axis=0))
        chosen = astuple(replace(options, weights=None, weight_axes=None))
        fingerprint = digest(moving, positions[~moving], *_flat(chosen))
        deformations = tuple(each.deformation for each in control_sets)
        return cls(assembly.surface, fingerprint, deformations, diagonal, options, assembly.obstacles)

    def agree_with(self, other: SessionInputs) -> bool:
        """Would both make the same session, up to the weights of the response?"""
        growth = max(self.diagonal, other.diagonal) <= LARGEST_GROWTH * min(self.diagonal, other.diagonal)
        same = _are_same(self.deformations, other.deformations) and _are_same(self.obstacles, other.obstacles)
        return growth and same and self.fingerprint == other.fingerprint and are_equal(self.surface, other.surface)


_kept: tuple[SessionInputs, stiv.EditSession, stiv.Deformation] | None = None


def keep_session(inputs: SessionInputs, session: stiv.EditSession, deformation: stiv.Deformation) -> None:
    """Keep a session that nothing else uses any more, and its deformation. They replace those that were kept."""
    global _kept
    session.end_drag()
    _kept = inputs, session, deformation


def free_kept_data() -> None:
    """Free the kept session, its obstacles, and deformations. A running edit keeps its own."""
    global _kept
    _kept = None
    forget_static_meshes()
    clear_cache()


def take_session(inputs: SessionInputs, controls: Floats) -> tuple[stiv.EditSession, stiv.Deformation] | None:
    """The kept session at these controls, (m, 3), and its deformation, if it was made from the same inputs.

    Then none is kept any more.
    """
    global _kept
    kept, _kept = _kept, None
    if kept is None or not kept[0].agree_with(inputs):
        return None
    (_, session, deformation), options = kept, inputs.options
    try:
        session.restore(controls)
        if not _weighs_alike(kept[0].options, options):
            session.set_weights(options.weights, options.weight_axes)
    except (stiv.InfeasibleError, stiv.StartIntersectsError):
        return None
    return session, deformation


def _are_same(ours: Sequence[object], theirs: Sequence[object]) -> bool:
    return len(ours) == len(theirs) and all(a is b for a, b in zip(ours, theirs, strict=True))


def _weighs_alike(a: stiv.EditOptions, b: stiv.EditOptions) -> bool:
    return digest(a.weights, a.weight_axes) == digest(b.weights, b.weight_axes)


def _flat(values: Sequence[Any]) -> list[Any]:
    """The arrays and plain values in nested tuples and lists."""
    rows = [_flat(value) if isinstance(value, tuple | list) else [value] for value in values]
    return [value for row in rows for value in row]
