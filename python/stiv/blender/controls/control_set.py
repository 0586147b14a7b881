# SPDX-License-Identifier: GPL-3.0-or-later
"""Data of an edit: its participants, and their controls with deformation, goal and writer."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from numpy.typing import NDArray

import stiv
from stiv.blender.controls.motion import Motion
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.references import ObjectReference
from stiv.seams import Seams

if TYPE_CHECKING:
    from stiv.blender.controls.bone_channels import BoneChannels
    from stiv.blender.controls.observed_stack import ObservedStack
    from stiv.blender.controls.placed_stack import PlacedStack
    from stiv.blender.controls.posed_surface import PosedSurface


@dataclass(frozen=True)
class Participant:
    """An object with controls; the goal moves it if it is `selected`.

    Its role is "cage", "soft", "lattice", "curve", "bones" or "rigid". `bones` are those of a rig that the goal moves;
    none for the selected ones. `torn` are surfaces, (n, 3), of poses in which seams are open (`PosedSurface.opened`).
    """

    reference: ObjectReference
    role: str
    selected: bool
    bones: "tuple[BoneChannels, ...]" = ()
    torn: tuple[Floats, ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class ShownAs:
    """Where a surface was read: the name of the object that shows it, and the evaluation."""

    owner: str
    evaluation: str


class Writer(Protocol):
    """Writes controls into Blender."""

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3). Raises SceneChangedError if the object was removed or changed."""

    def restore(self) -> None:
        """Restore the start exactly."""


class GoalRule(Protocol):
    """Maps a transform of the selection to a goal of the controls."""

    @property
    def moves(self) -> bool:
        """Does the transform move any of the controls?"""

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the controls, (m, 3), for an absolute motion since the start.

        `controls` are those at the start. `last` is the previous goal, which allows rotations beyond half a turn.
        """

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """Values on which `limited` depends, for comparison; () if the motion limits nothing."""

    def limited(self, control_set: "ControlSet", motion: Motion, weight: float) -> "ControlSet":
        """The given control set, the one of the start, with the response that a motion allows.

        weight: response weight of the controls that the motion moves.
        """

    def turned(self, controls: Floats, goal: Floats) -> float:
        """Angle in radians by which moving controls, (m, 3), rotate though their goal does not; 0 for points."""


class UnlimitedGoal:
    """Base of rules whose control sets respond alike in all motions, and which contact does not turn."""

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """The motion limits nothing."""
        return ()

    def limited(self, control_set: "ControlSet", motion: Motion, weight: float) -> "ControlSet":
        """The control set itself."""
        return control_set

    def turned(self, controls: Floats, goal: Floats) -> float:
        """0: nothing turns that does not belong to the goal."""
        return 0.0


@dataclass(frozen=True)
class ControlSet:
    """The controls of one cage, mesh with handles, lattice or group of rigid objects.

    Attributes:
        names: the objects that are written.
        role: "cage", "soft", "lattice", "curve", "bones" or "rigid".
        surfaces: indices of the visible meshes that the controls move, in the order of the deformation.
        deformation: from the controls to the world positions of these meshes, without duplicates on seams.
        controls: (m, 3) at the start.
        weights: response weights, (m,), or (m, 3) along three axes.
        max_weights: upper bounds of the weights, of the same shape, whatever yields; 0 pins a control.
        frame: (4, 4) in which the controls are stored in single precision; None for placements.
        rule: maps a motion to the goal of the controls.
        writer: writes the controls into Blender.
        control_seams: vertices of the object that share a control, so that seams stay closed; None if none do.
        seams: for each of `surfaces`, the vertices that stay together; empty if none do.
        note: message for the user; may be "".
        passenger_note: message on selected objects without a surface that cannot move along; in the first set.
        weight_axes: axes of (m, 3) weights as columns of rotations, (m, 3, 3); None for the world axes.
        kept: controls that are left of mirrored groups, by their former numbers, (m,); None without mirrored editing.
        observed: the stack of modifiers that Blender evaluates during the edit; None if all are known.
        placed: the same for objects that move as a whole; None if they keep their shape.
        posed: the same for bones; None for all other controls.
    """

    names: tuple[str, ...]
    role: str
    surfaces: tuple[int, ...]
    deformation: stiv.Deformation
    controls: Floats
    weights: Floats
    max_weights: Floats
    frame: Floats | None
    rule: GoalRule
    writer: Writer
    control_seams: Seams | None = None
    seams: tuple[Seams | None, ...] = ()
    note: str = ""
    passenger_note: str = ""
    weight_axes: Floats | None = None
    kept: Indices | None = None
    observed: "ObservedStack | None" = None
    placed: "PlacedStack | None" = None
    posed: "PosedSurface | None" = None

    def values_at_controls(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values at the controls, (m, ...), from values at all vertices of the object, (n, ...)."""
        return values if self.control_seams is None else values[self.control_seams.first]
