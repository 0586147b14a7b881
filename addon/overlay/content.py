# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is to draw, in world positions; knows nothing of Blender."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Clearance:
    """The nearest pair: two points, (3,), their distance, and the names of what they are on."""

    first: Any
    second: Any
    distance: float
    names: tuple[str, ...] = ()


@dataclass
class Content:
    """All that may be drawn; what is None or empty is not.

    Attributes:
        contacts: where an edit is held up, (k, 3), and the directions blocked there, (k, 3).
        intersecting: triangles, (t, 3, 3).
        clearance: the nearest pair.
        milliseconds: what the last step of an edit took.
        frames: drawn steps of the edit a second.
        alert: lines on what the live guard could not correct.
    """

    contacts: tuple[Any, Any] | None = None
    intersecting: Any = field(default_factory=lambda: np.empty((0, 3, 3)))
    clearance: Clearance | None = None
    milliseconds: float | None = None
    frames: float | None = None
    alert: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        """Is there anything?"""
        return bool(
            self.contacts is not None
            or len(self.intersecting)
            or self.clearance
            or self.milliseconds is not None
            or self.alert
        )


def lines_of(content: Content, chosen: Any, length: float) -> dict[str, Any]:
    """End points, (2 n, 3), of what is drawn as lines, by the name of its colour.

    chosen: has the switches `contacts` and `clearance`. length: of an arrow, world units.
    """
    lines = {}
    if content.contacts is not None and chosen.contacts and len(content.contacts[0]):
        points, blocked = content.contacts
        lines["contact"] = crosses(points, length / 6)
        lines["blocked"] = arrows(points, blocked, length)
    if content.clearance is not None and chosen.clearance:
        lines["clearance"] = np.array([content.clearance.first, content.clearance.second])
    return lines


def crosses(points: Any, half: float) -> Any:
    """Three short lines through each point, (k, 3): (6 k, 3)."""
    steps = half * np.array([axis * sign for axis in np.eye(3) for sign in (-1.0, 1.0)])
    return (points[:, None] + steps).reshape(-1, 3)


def arrows(points: Any, directions: Any, length: float) -> Any:
    """A shaft with two barbs at each point, along unit directions, (k, 3): (6 k, 3)."""
    tips = points + length * directions
    across = np.cross(directions, np.eye(3)[np.abs(directions).argmin(axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    back = tips - 0.3 * length * directions
    barbs = [back + 0.15 * length * across, back - 0.15 * length * across]
    return np.stack([points, tips, tips, barbs[0], tips, barbs[1]], axis=1).reshape(-1, 3)


def texts_of(content: Content, chosen: Any, length_text: Any, say: Callable[[str], str] = str) -> list[str]:
    """Lines of text for the corner of the view.

    length_text: from a length to how the scene writes it; say: from a text to the language of the interface.
    """
    texts = []
    if content.clearance is not None and chosen.clearance:
        between = f" ({', '.join(content.clearance.names)})" if content.clearance.names else ""
        texts.append(say("Clearance {}").format(length_text(content.clearance.distance)) + between)
    if len(content.intersecting) and chosen.intersections:
        count = len(content.intersecting)
        texts.append(say("1 intersecting triangle" if count == 1 else "{} intersecting triangles").format(count))
    if content.contacts is not None and chosen.contacts:
        count = len(content.contacts[0])
        texts.append(say("1 contact" if count == 1 else "{} contacts").format(count))
    if content.milliseconds is not None and chosen.speed:
        rate = f", {content.frames:.0f} fps" if content.frames else ""
        texts.append(f"{content.milliseconds:.0f} ms{rate}")
    return texts
