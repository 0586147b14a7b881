# SPDX-License-Identifier: GPL-3.0-or-later
"""The axes that the user chose for a transform, and the directions that they leave to contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ... import stiv_blender
from ...modal.state import State
from ...transform import Transform
from ...transform.frame import Frame, orthonormal
from ...transform.rotation import Rotation
from ...transform.scaling import Scaling
from ...transform.view import Vector


@dataclass(frozen=True)
class Constraint:
    """Flags of the chosen axes, and the axes, (3, 3) unit columns. None or all chosen: no constraint."""

    chosen: tuple[bool, ...] = (False, False, False)
    axes: Vector = field(default_factory=lambda: np.eye(3))

    @property
    def active(self) -> bool:
        """Whether some axes are locked."""
        return any(self.chosen) and not all(self.chosen)


def constraint_of(state: State, frame: Frame) -> Constraint:
    """The constraint of a drag's axis lock."""
    chosen = tuple(axis in state.axis_lock.axes for axis in range(3))
    return Constraint(chosen, frame.axes_of(state.axis_lock)) if not all(chosen) else Constraint()


def free_directions(transform: Transform, constraint: Constraint) -> stiv_blender.FreeDirections | None:
    """The directions along which contact may move the selection; None for all.

    A rotation about a chosen axis leaves the plane across it. Factors that differ choose the axes that they scale.
    """
    if isinstance(transform, Scaling):
        chosen = np.array(constraint.chosen) if constraint.active else transform.factors != 1.0
        if not constraint.active and np.ptp(transform.factors) == 0.0:
            return None
        return stiv_blender.FreeDirections(orthonormal(transform.axes), chosen)
    if not constraint.active:
        return None
    if isinstance(transform, Rotation):
        return stiv_blender.FreeDirections.line(transform.axis).opposite
    return stiv_blender.FreeDirections(orthonormal(constraint.axes), np.array(constraint.chosen))
