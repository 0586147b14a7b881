# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares two states of a scene, and tells whether an edit can reproduce the changes."""

from dataclasses import dataclass

import numpy as np

from stiv.blender.guard.scene_state import ObjectState, SceneState
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class Change:
    """The change of one object.

    Attributes:
        moved, turned, scaled: location, rotation or scale changed.
        points: (m,) flags of the vertices or points that moved in its own frame; None if none did.
    """

    reference: ObjectReference
    moved: bool
    turned: bool
    scaled: bool
    points: np.ndarray[tuple[int], np.dtype[np.bool_]] | None

    @property
    def placed(self) -> bool:
        """Did location, rotation or scale change?"""
        return self.moved or self.turned or self.scaled


@dataclass(frozen=True)
class Changes:
    """All changes. `unsupported` describes a change that no edit can reproduce; "" if there is none."""

    changes: tuple[Change, ...]
    unsupported: str = ""

    def __bool__(self) -> bool:
        """Did anything change?"""
        return bool(self.changes or self.unsupported)


def compare(before: SceneState, after: SceneState) -> Changes:
    """Find the changes from `before` to `after`."""
    for number in before.keys() ^ after.keys():
        name = (before.get(number) or after[number]).reference.name
        return Changes((), f'object "{name}" was {"added or shown" if number in after else "removed or hidden"}')
    found = []
    for number, state in after.items():
        if state.kind != before[number].kind:
            return Changes((), f'the structure of object "{state.reference.name}" was changed')
        change = _compare(before[number], state)
        if change.placed and change.points is not None:
            return Changes((), f'object "{state.reference.name}" was transformed and deformed at once')
        if change.placed or change.points is not None:
            found.append(change)
    return Changes(tuple(found), "" if found else _posed(before, after))


def _posed(before: SceneState, after: SceneState) -> str:
    """The pose or shape keys that changed; "" for none. Drivers may change them together with controls."""
    for number, state in after.items():
        if state.pose != before[number].pose:
            return f'the pose or shape keys of object "{state.reference.name}" were changed'
    return ""


def _compare(before: ObjectState, after: ObjectState) -> Change:
    points = None
    if before.points is not None and after.points is not None and not before.has_same_points(after):
        points = (before.points != after.points).any(axis=1)
    return Change(
        after.reference, before.location != after.location, before.rotation != after.rotation,
        before.scale != after.scale, points,
    )  # fmt: skip
