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
    """All changes.

    Attributes:
        changes: those that an edit can reproduce.
        added: objects that were added or shown.
        removed: names of objects that were removed or hidden.
        posed: objects with another pose or other values of shape keys.
        rebuilt: objects with other vertices, another parent or rotation mode, or transformed and deformed at once.
        unsupported: describes the first change that no edit can reproduce; "" if there is none.
    """

    changes: tuple[Change, ...]
    unsupported: str = ""
    added: tuple[ObjectReference, ...] = ()
    rebuilt: tuple[ObjectReference, ...] = ()
    removed: tuple[str, ...] = ()
    posed: tuple[ObjectReference, ...] = ()

    def __bool__(self) -> bool:
        """Did anything change?"""
        return bool(self.changes or self.unsupported or self.posed)


def compare(before: SceneState, after: SceneState) -> Changes:
    """Find the changes from `before` to `after`."""
    found, rebuilt, reasons = [], [], []
    added = [state.reference for number, state in after.items() if number not in before]
    reasons += [f"{each.name} was added or shown" for each in added]
    removed = tuple(state.reference.name for number, state in before.items() if number not in after)
    reasons += [f"{name} was removed or hidden" for name in removed]
    for number, state in after.items():
        if number not in before:
            continue
        reference = state.reference
        if state.kind != before[number].kind:
            rebuilt.append(reference)
            reasons.append(f"{reference.name} has another structure")
            continue
        change = _compare(before[number], state)
        if change.placed and change.points is not None:
            rebuilt.append(reference)
            reasons.append(f"{reference.name} was transformed and deformed at once")
        elif change.placed or change.points is not None:
            found.append(change)
    common = [(before[number], state) for number, state in after.items() if number in before]
    posed = [state.reference for former, state in common if state.pose != former.pose and state.kind == former.kind]
    return Changes(tuple(found), "".join(reasons[:1]), tuple(added), tuple(rebuilt), removed, tuple(posed))


def _compare(before: ObjectState, after: ObjectState) -> Change:
    points = None
    if before.points is not None and after.points is not None and not before.has_same_points(after):
        points = (before.points != after.points).any(axis=1)
    return Change(
        after.reference, before.location != after.location, before.rotation != after.rotation,
        before.scale != after.scale, points,
    )  # fmt: skip
