# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user may choose for an edit, as plain values."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from stiv import InputError
from stiv.blender.scene.exclusions import Exclusions
from stiv.choices import BOUNDARIES, DEFORMATIONS, GUARDS, OBJECT_RESPONSES, OPERATORS, RESPONDERS, RESTS, ROLES
from stiv.edit_options import SharedOptions

Kind = Literal["move", "rotate", "scale"]


@dataclass(frozen=True)
class Handles:
    """By what the vertices of a mesh are moved, where its deformation is "laplacian" or "arap".

    Attributes:
        groups: vertex groups, each a handle. In Edit Mode the selected vertices are a handle too, and the one that
            moves; in Object Mode the active group moves if it is a handle, otherwise all of them.
        anchor: a vertex group that stays where it is, handles in it as well; "" for none.
        rest: all other vertices: "follows" or "stays".
        pull: how hard a handle pulls, times the weight in its group; 0: it holds its vertices exactly.
    """

    groups: tuple[str, ...] = ()
    anchor: str = ""
    rest: str = "follows"
    pull: float = 0.0

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("rest", self.rest, RESTS)
        if not 0 <= self.pull < float("inf"):
            raise InputError(f"pull: {self.pull!r} is not a number from 0 on")


@dataclass(frozen=True)
class WeightGroup:
    """How far each control of an object gives way: its weight in a vertex group, 0 where it is not in the group.

    0 pins it, so that not even the edit moves it.

    Attributes:
        name: the vertex group.
        inverted: use one minus the weight.
        axes: to which axes of the object's local space the weight applies, X, Y, Z; along the others it is 1. Blender's
            own locks of an object's location are along its parent's axes instead.
    """

    name: str
    inverted: bool = False
    axes: tuple[bool, bool, bool] = (True, True, True)

    def __post_init__(self) -> None:
        """Refuse anything but a choice for each axis."""
        if len(self.axes) != 3 or any(each not in (True, False) for each in self.axes):
            raise InputError(f"axes: {self.axes!r} is not true or false for each of X, Y, Z")


@dataclass(frozen=True)
class LoopSurface:
    """A cage of triangles, subdivided by Loop's scheme, and the object that shows it.

    Attributes:
        object: its name; it is a child of the cage and takes part in the cage's place.
        levels: 1 to 3.
        boundary: "all": corners of the boundary are rounded; "preserve_corners": they stay.
    """

    object: str
    levels: int = 2
    boundary: str = "all"

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("boundary", self.boundary, BOUNDARIES)
        if self.levels not in (1, 2, 3):
            raise InputError(f"levels: {self.levels!r} is none of 1, 2, 3")


@dataclass(frozen=True)
class EditSettings(SharedOptions):
    """Choices for one edit. `stiv.EditOptions` describes separation, smoothness, constraints, time_budget and threads.

    Attributes:
        pair_separations: distances that pairs of objects keep instead, by their names; twice the same name for an
            object with itself. Objects that show nothing do not count.
        interference: False: nothing gives way and nothing is tested, surfaces may go through each other;
            `BlenderEdit.set_interference` changes it in mid-edit.
        responders: which controls give way: the "selected" ones that are being moved (default), the "unselected" ones
            (what is moved then keeps to the goal exactly), or "all". In Object Mode the unselected are all visible
            objects that may be placed: as rigid wholes, or by the deformation that is chosen for them. In Edit Mode
            they are the unselected vertices or points.
        object_response: how selected objects respond in Object Mode: "rigid" (placement) or "deform" (vertices of a
            mesh's cage, points of a lattice).
        deformations: by object name, by what it is moved and gives way: "auto" (as `object_response` says), "vertices"
            (of its cage, or points of a lattice), "laplacian" or "arap" (handles of a mesh), "lattice" (the points of
            the lattice that deforms it), or "rigid". In Edit Mode only "laplacian" and "arap" count.
        handles: by object name, for "laplacian" and "arap".
        weights: by object name, for cages, handles and lattices.
        loops: by name of the cage; what shows a cage takes part by the cage's role, and the cage itself does not.
        roles: by object name, "auto" | "controls" | "rigid" | "obstacle" | "ignored". An unselected object of role
            "controls" or "rigid" gives way, whatever `responders` says; of role "auto" where `responders` says so; an
            "obstacle" never does.
        ignored_pairs: pairs of object names that may go through each other; twice the same name for an object
            with itself.
        excluded: pairs of faces that intersect already and may go on to; all others are guarded.
        guard: what is kept free of intersections: what the "viewport" shows (in Edit Mode what Object Mode shows too),
            what is rendered ("render"), or "both"; "auto": both where they differ and the surface stays small enough.
    """

    pair_separations: tuple[tuple[str, str, float], ...] = ()
    interference: bool = True
    responders: str = "selected"
    object_response: str = "rigid"
    deformations: Mapping[str, str] = field(default_factory=dict)
    handles: Mapping[str, Handles] = field(default_factory=dict)
    weights: Mapping[str, WeightGroup] = field(default_factory=dict)
    loops: Mapping[str, LoopSurface] = field(default_factory=dict)
    roles: Mapping[str, str] = field(default_factory=dict)
    ignored_pairs: tuple[tuple[str, str], ...] = ()
    excluded: Exclusions = field(default_factory=Exclusions)
    guard: str = "auto"

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("responders", self.responders, RESPONDERS)
        _require("guard", self.guard, GUARDS)
        _require("object_response", self.object_response, OBJECT_RESPONSES)
        for first, second, distance in self.pair_separations:
            if not 0 < distance < float("inf"):
                raise InputError(
                    f'separation of objects "{first}" and "{second}": {distance!r} is not a positive number'
                )
        for name, role in self.roles.items():
            _require(f'role of object "{name}"', role, ROLES)
        for name, deformation in self.deformations.items():
            _require(f'deformation of object "{name}"', deformation, DEFORMATIONS)

    def role(self, name: str) -> str:
        """Role of the object of this name."""
        return self.roles.get(name, "auto")

    def deformation(self, name: str) -> str:
        """By what the object of this name is moved."""
        return self.deformations.get(name, "auto")

    def shown_by(self, name: str) -> str:
        """Name of the object that shows the surface of the object of this name."""
        return self.loops[name].object if name in self.loops else name

    def cage_of(self, name: str) -> str:
        """Name of the cage that the object of this name shows; its own where it shows itself."""
        return next((cage for cage, loop in self.loops.items() if loop.object == name), name)

    def takes_part(self, name: str) -> bool:
        """Does the surface of the object of this name count?"""
        return name not in self.loops and self.role(self.cage_of(name)) != "ignored"

    def named_objects(self) -> Iterator[str]:
        """Every name of an object that the choices mention."""
        yield from (*self.roles, *self.deformations, *self.handles, *self.weights, *self.loops)
        yield from (loop.object for loop in self.loops.values())
        yield from (name for pair in self.ignored_pairs for name in pair)
        yield from (name for first, second, _ in self.pair_separations for name in (first, second))

    def weight(self, selected: bool) -> float:
        """Response weight of controls that the goal moves (`selected`) or that it does not."""
        return 1.0 if self.responders in ("all", "selected" if selected else "unselected") else 0.0


def check_kind(kind: str) -> None:
    """Refuse an unknown kind of edit. Raises InputError."""
    _require("kind", kind, OPERATORS)


def _require(what: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise InputError(f"{what}: {value!r} is none of {', '.join(allowed)}")
