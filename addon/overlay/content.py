# SPDX-License-Identifier: GPL-3.0-or-later
"""The content of the overlay, in world positions, without Blender."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from ..modal.header_texts import Translate

if TYPE_CHECKING:
    from ..stiv_blender import ContactRegion, Ghost

Floats = NDArray[np.float64]
CONTACT_ALPHA, GHOST_ALPHA, GHOST_BOX_ALPHA, FACE_ALPHA = 0.4, 0.15, 0.6, 0.5


class Switches(Protocol):
    """The switches of the overlay."""

    contacts: bool
    goal: bool
    intersections: bool
    clearance: bool
    speed: bool


@dataclass(frozen=True)
class Clearance:
    """The closest pair: two points, (3,), their distance, and the names of their objects."""

    first: Floats
    second: Floats
    distance: float
    names: tuple[str, ...] = ()


@dataclass
class Content:
    """Everything that may be drawn; None and empty arrays are not.

    Attributes:
        contacts: the faces that hold an edit up.
        ghost: the moved objects at the goal of an edit.
        intersecting: triangles, (t, 3, 3).
        clearance: the closest pair.
        milliseconds: time of the last step of an edit.
        frames: drawn steps of the edit per second.
        alert: lines on the problem that the live guard could not correct.
    """

    contacts: ContactRegion | None = None
    ghost: Ghost | None = None
    intersecting: Floats = field(default_factory=lambda: np.empty((0, 3, 3)))
    clearance: Clearance | None = None
    milliseconds: float | None = None
    frames: float | None = None
    alert: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        """Whether there is anything to draw."""
        return bool(
            (self.contacts is not None and len(self.contacts.triangles))
            or self.ghost
            or len(self.intersecting)
            or self.clearance
            or self.milliseconds is not None
            or self.alert
        )


@dataclass(frozen=True)
class Shape:
    """Primitives of one colour to draw.

    Attributes:
        kind: "TRIS" or "LINES".
        colour: name of the colour.
        points: (n, 3) positions.
        alpha: opacity.
        strengths: (n,) factor of the opacity at each point; empty for 1.
        indices: of the points of each primitive; empty if the points are in order.
        culled: whether faces that look away are left out.
    """

    kind: str
    colour: str
    points: Floats
    alpha: float = 1.0
    strengths: Floats = field(default_factory=lambda: np.empty(0))
    indices: NDArray[np.int32] = field(default_factory=lambda: np.empty((0, 2), np.int32))
    culled: bool = False


def shapes_of(content: Content, switches: Switches) -> dict[str, Shape]:
    """The shapes to draw by name, in order."""
    shapes = {}
    if content.ghost is not None and switches.goal:
        ghost = content.ghost
        is_box = len(ghost.edges) > 0
        kind, indices = ("LINES", ghost.edges) if is_box else ("TRIS", ghost.triangles)
        alpha = GHOST_BOX_ALPHA if is_box else GHOST_ALPHA
        shapes["ghost"] = Shape(kind, "goal", ghost.points, alpha, indices=indices, culled=not is_box)
    if content.contacts is not None and len(content.contacts.triangles) and switches.contacts:
        corners, strengths = content.contacts.triangles, content.contacts.strengths
        shapes["contacts"] = Shape("TRIS", "contact", corners.reshape(-1, 3), CONTACT_ALPHA, strengths.ravel())
    if len(content.intersecting) and switches.intersections:
        shapes["faces"] = Shape("TRIS", "intersecting", content.intersecting.reshape(-1, 3), FACE_ALPHA)
    if content.clearance is not None and switches.clearance:
        ends = np.array([content.clearance.first, content.clearance.second])
        shapes["clearance"] = Shape("LINES", "clearance", ends)
    return shapes


def texts_of(
    content: Content, switches: Switches, length_text: Callable[[float], str], translate: Translate = str
) -> list[str]:
    """Lines of text for the corner of the view. length_text: formats a length."""
    texts = []
    if content.clearance is not None and content.clearance.names and switches.clearance:
        between = ", ".join(content.clearance.names)
        texts.append(translate("{}: clearance {}").format(between, length_text(content.clearance.distance)))
    if content.milliseconds is not None and switches.speed:
        rate = f", {content.frames:.0f} fps" if content.frames else ""
        texts.append(f"{content.milliseconds:.0f} ms{rate}")
    return texts
