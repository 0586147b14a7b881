# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices of an edit, as plain data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from stiv import InputError
from stiv.blender.excluded_faces import Exclusions
from stiv.choices import (
    BOUNDARIES,
    DEFORMATIONS,
    FORMER_RESPONSES,
    GUARDS,
    OBJECT_RESPONSES,
    OPERATORS,
    RESPONDERS,
    RESTS,
    ROLES,
)
from stiv.edit_options import SharedOptions

Kind = Literal["move", "rotate", "scale"]


@dataclass(frozen=True)
class Handles:
    """Handles of a mesh whose deformation is "laplacian" or "arap".

    Attributes:
        groups: vertex groups, each a handle. In Edit Mode the selected vertices are a handle too, and the one that
            moves. In Object Mode the active group moves if it is a handle, otherwise all handles move.
        anchor: vertex group that stays fixed, including handles in it; "" for none.
        rest: all other vertices: "follows" (deformed) or "stays" (fixed).
        pull: handle stiffness, multiplied by the weight in the group; 0 holds the vertices exactly.
    """

    groups: tuple[str, ...] = ()
    anchor: str = ""
    rest: str = "follows"
    pull: float = 0.0

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("rest", self.rest, RESTS)
        if not 0 <= self.pull < float("inf"):
            raise InputError(f"pull: {self.pull!r} must be a finite number of at least 0")


@dataclass(frozen=True)
class WeightGroup:
    """Response weight of each control: its weight in a vertex group, 0 outside the group.

    Weight 0 pins a control, so that not even the edit moves it.

    Attributes:
        name: the vertex group.
        inverted: use one minus the weight.
        axes: local axes X, Y, Z to which the weight applies; along the others it is 1. Blender's location locks use the
            axes of the parent instead.
    """

    name: str
    inverted: bool = False
    axes: tuple[bool, bool, bool] = (True, True, True)

    def __post_init__(self) -> None:
        """Refuse anything but a choice for each axis."""
        if len(self.axes) != 3 or any(each not in (True, False) for each in self.axes):
            raise InputError(f"axes: {self.axes!r} must be true or false for each of X, Y, Z")


@dataclass(frozen=True)
class LoopSurface:
    """A triangle cage with Loop subdivision, and the object that shows it.

    Attributes:
        object: name of the object that shows the cage; a child of the cage that participates instead of it.
        levels: 1 to 3.
        boundary: "all" rounds corners of the boundary, "preserve_corners" keeps them.
    """

    object: str
    levels: int = 2
    boundary: str = "all"

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("boundary", self.boundary, BOUNDARIES)
        if self.levels not in (1, 2, 3):
            raise InputError(f"levels: {self.levels!r} must be 1, 2 or 3")


@dataclass(frozen=True)
class EditSettings(SharedOptions):
    """Choices for one edit; separation, smoothness, tight, constraints, time_budget and threads as in
    stiv.EditOptions.

    Attributes:
        pair_separations: minimum distances of pairs of objects by name, used instead of `separation`; the same name
            twice for an object with itself. Objects without a surface have no effect.
        interference: False switches collisions off: nothing is deflected or tested, and surfaces may intersect.
            `BlenderEdit.set_interference` changes it during an edit.
        responders: which controls yield: those that the edit moves ("selected", default), all others ("unselected": the
            selection then follows the goal exactly), or "all". In Object Mode "unselected" covers all visible objects
            that can be moved, rigidly or by their own deformation; in Edit Mode the unselected vertices or points;
            in Pose Mode the other bones, or the objects with their own deformation if there are any.
        object_response: how objects respond in Object Mode: "slide" (default; Move never rotates an object),
            "slide_and_turn", or "deform" (selected objects by the vertices of their cage or the points of a lattice,
            all others slide). "rigid", of version 0.1.0, is "slide_and_turn".
        slide_out_of_axis: contact may move the selection along locked axes (`Motion.free`) too.
        deformations: how an object deforms on contact, by name: "auto" (see `object_response`), "vertices" (of its
            cage, or points of a lattice), "laplacian" or "arap" (handles of a mesh), "lattice" (points of the lattice
            that deforms it), or "rigid". Edit Mode uses only "laplacian" and "arap".
        handles: by object name, for "laplacian" and "arap".
        weights: by object name, for cages, handles and lattices.
        loops: by name of the cage. The object that shows a cage participates instead of it, with the cage's role.
        roles: by object name: "auto", "controls", "rigid", "obstacle" or "ignored" (no collision). Unselected objects
            with the role "controls" or "rigid" always yield, those with "auto" depend on `responders`.
        ignored_pairs: pairs of object names that pass through each other, which nothing tests (Let These Pass); the
            same name twice for an object with itself.
        excluded: pairs of faces that intersect already. Those of one object may continue to, those of two objects may
            overlap no more than at the start.
        joint_region: skin around joints that turn, which may fold: its distance from the joint in radii of the limb. It
            is not tested against itself and its neighbours. 0 tests all skin.
        guard: the evaluations that stay free of intersections: "viewport" (in Edit Mode also what Object Mode shows),
            "render" or "both"; "auto" is "both" where they differ and the surface is small enough.
    """

    pair_separations: tuple[tuple[str, str, float], ...] = ()
    interference: bool = True
    responders: str = "selected"
    object_response: str = "slide"
    slide_out_of_axis: bool = False
    deformations: Mapping[str, str] = field(default_factory=dict)
    handles: Mapping[str, Handles] = field(default_factory=dict)
    weights: Mapping[str, WeightGroup] = field(default_factory=dict)
    loops: Mapping[str, LoopSurface] = field(default_factory=dict)
    roles: Mapping[str, str] = field(default_factory=dict)
    ignored_pairs: tuple[tuple[str, str], ...] = ()
    excluded: Exclusions = field(default_factory=Exclusions)
    joint_region: float = 2.0
    guard: str = "auto"

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("responders", self.responders, RESPONDERS)
        _require("guard", self.guard, GUARDS)
        if not 0 <= self.joint_region < float("inf"):
            raise InputError(f"joint_region: {self.joint_region!r} must be a finite number of at least 0")
        response = FORMER_RESPONSES.get(self.object_response, self.object_response)
        object.__setattr__(self, "object_response", response)
        _require("object_response", self.object_response, OBJECT_RESPONSES)
        for first, second, distance in self.pair_separations:
            if not 0 < distance < float("inf"):
                raise InputError(f"{first}, {second}: the minimum distance {distance!r} is not a positive number")
        for name, role in self.roles.items():
            _require(f'role of object "{name}"', role, ROLES)
        for name, deformation in self.deformations.items():
            _require(f'deformation of object "{name}"', deformation, DEFORMATIONS)

    def role(self, name: str) -> str:
        """Role of the named object."""
        return self.roles.get(name, "auto")

    def deformation(self, name: str) -> str:
        """Deformation of the named object."""
        return self.deformations.get(name, "auto")

    def shown_by(self, name: str) -> str:
        """Name of the object that shows the surface of the named object."""
        return self.loops[name].object if name in self.loops else name

    def cage_of(self, name: str) -> str:
        """Name of the cage that the named object shows; its own name if it shows itself."""
        return next((cage for cage, loop in self.loops.items() if loop.object == name), name)

    def participates(self, name: str) -> bool:
        """Can the surface of the named object collide?"""
        return name not in self.loops and self.role(self.cage_of(name)) != "ignored"

    def named_objects(self) -> Iterator[str]:
        """All object names in the settings."""
        yield from (*self.roles, *self.deformations, *self.handles, *self.weights, *self.loops)
        yield from (loop.object for loop in self.loops.values())
        yield from (name for pair in self.ignored_pairs for name in pair)
        yield from (name for first, second, _ in self.pair_separations for name in (first, second))

    def response_weight(self, selected: bool) -> float:
        """Response weight of controls that the goal moves (`selected`), or of all others."""
        return 1.0 if self.responders in ("all", "selected" if selected else "unselected") else 0.0


def check_kind(kind: str) -> None:
    """Refuse an unknown kind of edit. Raises InputError."""
    _require("kind", kind, OPERATORS)


def _require(what: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise InputError(f"{what}: {value!r} is none of {', '.join(allowed)}")
