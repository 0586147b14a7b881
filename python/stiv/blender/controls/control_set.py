# SPDX-License-Identifier: GPL-3.0-or-later
"""One thing with controls: how its surface follows from them, what the goal asks of them, and how they are written."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.scene.arrays import Floats
from stiv.seams import Seams


class Writer(Protocol):
    """Puts controls into Blender."""

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3). Raises SceneChangedError when the object is gone or was changed."""

    def restore(self) -> None:
        """Put back what was there at the start, bit by bit."""


class GoalRule(Protocol):
    """What a transformation of the selection asks of controls."""

    @property
    def moves(self) -> bool:
        """Does the transformation move any of them?"""

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the controls, (m, 3), for an absolute motion since the start.

        `controls` are those of the start, `last` the goal before this one: rotations may go on beyond a half turn.
        """

    def reached(self, influence: Influence | None) -> NDArray[np.bool_]:
        """Which controls, (m,), a motion of this influence moves."""


@dataclass(frozen=True)
class Part:
    """One cage, mesh with handles, lattice or group of rigid objects.

    Attributes:
        names: the objects that are written.
        role: "cage", "soft", "lattice" or "rigid".
        surfaces: positions, in the list of visible meshes, of what the controls move, in the deformation's order.
        deformation: from the controls to the world positions of all these meshes, vertices of a seam once.
        controls: (m, 3) at the start.
        weights: (m,) response of each control, or (m, 3) of each along three axes.
        given: of the same shape, the most that each may have, whoever responds; 0 pins it.
        frame: (4, 4) in which the controls are stored in single precision, handles like the vertices that they hold;
            None for placements.
        rule: what the goal asks of the controls.
        writer: how the controls come into Blender.
        tied: vertices of the object that are one control, so that seams stay closed; None: each is its own.
        seams: of each of `surfaces`, the vertices that stay in one place; empty: none do.
        note: what the user should know of it; "" for nothing.
        weight_axes: (m, 3, 3) directions that (m, 3) weights are along, as columns of a rotation; None: x, y, z.
    """

    names: tuple[str, ...]
    role: str
    surfaces: tuple[int, ...]
    deformation: stiv.Deformation
    controls: Floats
    weights: Floats
    given: Floats
    frame: Floats | None
    rule: GoalRule
    writer: Writer
    tied: Seams | None = None
    seams: tuple[Seams | None, ...] = ()
    note: str = ""
    weight_axes: Floats | None = None

    def of_vertices(self, values: NDArray[Any]) -> NDArray[Any]:
        """Those of the controls, (m, ...), out of values of all vertices of the object, (n, ...)."""
        return values if self.tied is None else values[self.tied.first]
