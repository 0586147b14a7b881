# SPDX-License-Identifier: GPL-3.0-or-later
"""What a tool changed between two states of a scene, and whether motions of controls can tell it."""

from dataclasses import dataclass

import numpy as np

from stiv.blender.guard.scene_state import ObjectState, SceneState
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class Change:
    """What became of one object.

    Attributes:
        moved, turned, scaled: its location, rotation, scale is another one.
        points: (m,) which of its vertices or points are elsewhere in its own frame; None when none is.
    """

    reference: ObjectReference
    moved: bool
    turned: bool
    scaled: bool
    points: np.ndarray[tuple[int], np.dtype[np.bool_]] | None

    @property
    def placed(self) -> bool:
        """Does the object as a whole stand otherwise?"""
        return self.moved or self.turned or self.scaled


@dataclass(frozen=True)
class Changes:
    """All changes of controls. `obstacle` says what else is different, which no motion of controls can tell; empty if
    nothing is.
    """

    changes: tuple[Change, ...]
    obstacle: str = ""

    def __bool__(self) -> bool:
        """Is anything different?"""
        return bool(self.changes or self.obstacle)


def compare(before: SceneState, after: SceneState) -> Changes:
    """Find what is different in `after`."""
    for number in before.keys() ^ after.keys():
        name = (before.get(number) or after[number]).reference.name
        return Changes((), f'object "{name}" was {"added or shown" if number in after else "removed or hidden"}')
    found = []
    for number, state in after.items():
        if state.kind != before[number].kind:
            return Changes((), f'the structure of object "{state.reference.name}" was changed')
        change = _compare(before[number], state)
        if change.placed and change.points is not None:
            return Changes((), f'object "{state.reference.name}" was placed and deformed at once')
        if change.placed or change.points is not None:
            found.append(change)
    return Changes(tuple(found), "" if found else _posed(before, after))


def _posed(before: SceneState, after: SceneState) -> str:
    """Which pose or shape keys changed; "" for none. Beside changed controls, drivers may have changed them."""
    for number, state in after.items():
        if state.posture != before[number].posture:
            return f'the pose or the shape keys of object "{state.reference.name}" were changed'
    return ""


def _compare(before: ObjectState, after: ObjectState) -> Change:
    points = None
    if before.points is not None and after.points is not None and not before.has_points_of(after):
        points = (before.points != after.points).any(axis=1)
    return Change(
        after.reference, before.location != after.location, before.rotation != after.rotation,
        before.scale != after.scale, points,
    )  # fmt: skip
