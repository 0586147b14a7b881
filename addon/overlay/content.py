# SPDX-License-Identifier: GPL-3.0-or-later
"""The content of the overlay, in world positions, without Blender."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..modal.header_texts import Translate

Floats = NDArray[np.float64]


class Switches(Protocol):
    """The switches of the overlay."""

    contacts: bool
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
        contacts: positions where an edit is blocked, (k, 3), and the blocked directions, (k, 3).
        intersecting: triangles, (t, 3, 3).
        clearance: the closest pair.
        milliseconds: time of the last step of an edit.
        frames: drawn steps of the edit per second.
        alert: lines on the problem that the live guard could not correct.
    """

    contacts: tuple[Floats, Floats] | None = None
    intersecting: Floats = field(default_factory=lambda: np.empty((0, 3, 3)))
    clearance: Clearance | None = None
    milliseconds: float | None = None
    frames: float | None = None
    alert: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        """Whether there is anything to draw."""
        return bool(
            self.contacts is not None
            or len(self.intersecting)
            or self.clearance
            or self.milliseconds is not None
            or self.alert
        )


def lines_of(content: Content, switches: Switches, length: float) -> dict[str, Floats]:
    """End points, (2 n, 3), of the lines to draw, by the name of their colour. length: of an arrow, world units."""
    lines = {}
    if content.contacts is not None and switches.contacts and len(content.contacts[0]):
        points, blocked = content.contacts
        lines["contact"] = crosses(points, length / 6)
        lines["blocked"] = arrows(points, blocked, length)
    if content.clearance is not None and switches.clearance:
        lines["clearance"] = np.array([content.clearance.first, content.clearance.second])
    return lines


def crosses(points: Floats, half: float) -> Floats:
    """Three short lines through each point, (k, 3): (6 k, 3)."""
    steps = half * np.array([axis * sign for axis in np.eye(3) for sign in (-1.0, 1.0)])
    return np.asarray((points[:, None] + steps).reshape(-1, 3))


def arrows(points: Floats, directions: Floats, length: float) -> Floats:
    """A shaft with two barbs at each point, along unit directions, (k, 3): (6 k, 3)."""
    tips = points + length * directions
    across = np.cross(directions, np.eye(3)[np.abs(directions).argmin(axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    back = tips - 0.3 * length * directions
    barbs = [back + 0.15 * length * across, back - 0.15 * length * across]
    return np.stack([points, tips, tips, barbs[0], tips, barbs[1]], axis=1).reshape(-1, 3)


def texts_of(
    content: Content, switches: Switches, length_text: Callable[[float], str], translate: Translate = str
) -> list[str]:
    """Lines of text for the corner of the view. length_text: formats a length."""
    texts = []
    if content.clearance is not None and switches.clearance:
        between = f" ({', '.join(content.clearance.names)})" if content.clearance.names else ""
        texts.append(translate("Clearance {}").format(length_text(content.clearance.distance)) + between)
    if len(content.intersecting) and switches.intersections:
        count = len(content.intersecting)
        texts.append(translate("1 intersecting triangle" if count == 1 else "{} intersecting triangles").format(count))
    if content.contacts is not None and switches.contacts:
        count = len(content.contacts[0])
        texts.append(translate("1 contact" if count == 1 else "{} contacts").format(count))
    if content.milliseconds is not None and switches.speed:
        rate = f", {content.frames:.0f} fps" if content.frames else ""
        texts.append(f"{content.milliseconds:.0f} ms{rate}")
    return texts
