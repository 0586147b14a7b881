# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion of a rigid group in the world that its controls stand for."""

from dataclasses import dataclass

import numpy as np

from stiv.blender.controls.motion import ROUNDING
from stiv.blender.controls.rotations import affine_about, remove_rounding, rotation_matrix
from stiv.blender.scene.arrays import Floats, transform_points


@dataclass(frozen=True)
class PlacementMotion:
    """Centre and rotation vector, or centre and scale factors, (2, 3), as a motion since the start.

    Attributes:
        centre: (3,) at the start.
        pivot: (3,) point about which the group is rotated or scaled.
        axes: (3, 3) rotation, along whose columns the group is scaled; None for a rotation.
        origin: (3,) of the first object, if each object turns or scales about its own origin; None if all move as one.
    """

    centre: Floats
    pivot: Floats
    axes: Floats | None = None
    origin: Floats | None = None

    @property
    def rotation_rows(self) -> tuple[int, ...]:
        """Rows of the controls that are rotation vectors."""
        return (1,) if self.axes is None else ()

    def matrix(self, controls: Floats) -> Floats:
        """The motion, (4, 4)."""
        if self.axes is None:
            linear = rotation_matrix(remove_rounding(controls[1], unit=1.0))
        else:
            linear = (self.axes * self.factors(controls)) @ self.axes.T
        return affine_about(self.pivot, linear, self.pivot + remove_rounding(controls[0] - self.centre))

    def matrix_of(self, controls: Floats, place: Floats) -> Floats:
        """The motion, (4, 4), of an object of the group with this world matrix, (4, 4), at the start."""
        whole, own = self.matrix(controls), place[:3, 3]
        if self.origin is None or np.array_equal(own, self.origin):
            return whole
        shift = transform_points(whole, self.origin[None])[0] - self.origin
        return affine_about(own, whole[:3, :3], own + remove_rounding(shift))

    def factors(self, controls: Floats) -> Floats:
        """The scale factors, (3,); 1 for a rotation. Those that differ only by rounding are equal."""
        if self.axes is None:
            return np.ones(3)
        mean = controls[1].mean()
        differs = np.abs(controls[1] - mean).max() > ROUNDING * abs(mean)
        return controls[1] if differs else np.full(3, mean)
