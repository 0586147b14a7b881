# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user may choose for an edit, as plain values."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from stiv import InputError

Kind = Literal["move", "rotate", "scale"]

KINDS = ("move", "rotate", "scale")
RESPONDERS = ("selected", "unselected", "all")
OBJECT_RESPONSES = ("rigid", "deform")
ROLES = ("auto", "controls", "rigid", "obstacle", "ignored")


@dataclass(frozen=True)
class EditSettings:
    """Choices for one edit.

    Attributes:
        separation: distance that surfaces keep, world units; 0 chooses one.
        responders: which controls give way: the "selected" ones that are being moved (default), the "unselected" ones
            (what is moved then keeps to the goal exactly), or "all".
        object_response: how selected objects respond in Object Mode: "rigid" (placement) or "deform" (vertices of a
            mesh's cage, points of a lattice).
        roles: by object name, "auto" | "controls" | "rigid" | "obstacle" | "ignored". An unselected object takes part
            as an obstacle unless its role is "controls" or "rigid": then it gives way, whatever `responders` says.
        ignored_pairs: pairs of object names that may go through each other; twice the same name for an object
            with itself.
        smoothness: damping of the response; 0.1 smooth, 0.01 tight.
        constraints: "per_patch" or "single".
        threads: 0 for all.
        time_budget: seconds for each solve, 0 for none.
    """

    separation: float = 0.0
    responders: str = "selected"
    object_response: str = "rigid"
    roles: Mapping[str, str] = field(default_factory=dict)
    ignored_pairs: tuple[tuple[str, str], ...] = ()
    smoothness: float = 0.1
    constraints: str = "per_patch"
    threads: int = 0
    time_budget: float = 0.0

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        _require("responders", self.responders, RESPONDERS)
        _require("object_response", self.object_response, OBJECT_RESPONSES)
        for name, role in self.roles.items():
            _require(f'role of object "{name}"', role, ROLES)

    def role(self, name: str) -> str:
        """Role of the object of this name."""
        return self.roles.get(name, "auto")

    def weight(self, selected: bool) -> float:
        """Response weight of controls that the goal moves (`selected`) or that it does not."""
        return 1.0 if self.responders in ("all", "selected" if selected else "unselected") else 0.0


def check_kind(kind: str) -> None:
    """Refuse an unknown kind of edit. Raises InputError."""
    _require("kind", kind, KINDS)


def _require(what: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise InputError(f"{what}: {value!r} is none of {', '.join(allowed)}")
