# SPDX-License-Identifier: GPL-3.0-or-later
"""What the guard has done to the scene: through `stiv.blender`, with nothing of the interface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from ..settings import edit_settings
from ..wording import say


@dataclass(frozen=True)
class Outcome:
    """What came of it.

    Attributes:
        free: the scene is free of intersections now.
        wrote: something was written.
        text: what to tell the user, empty for nothing.
    """

    free: bool
    wrote: bool = False
    text: str = ""


def read(context: Any) -> Any:
    """The state of all controls, a `stiv.blender.SceneState`."""
    from stiv.blender import read_state  # the add-on registers without the native module

    return read_state(context)


def take_strokes(context: Any) -> None:
    """Let Blender evaluate what was sculpted, which it only draws: what others read of it is as before the strokes."""
    context.object.update_tag(refresh={"DATA"})
    context.view_layer.update()


def differs(accepted: Any, present: Any) -> bool:
    """Are any controls other than accepted?"""
    from stiv.blender import compare

    return bool(compare(accepted, present))


def test(context: Any) -> Outcome:
    """Is the scene free as it is, but for what may intersect?"""
    from stiv.blender import check_scene

    settings = _settings(context)
    try:
        pairs = settings.excluded.others(check_scene(context, settings).pairs)
    except ValueError as error:
        return Outcome(False, text=str(error))
    if not pairs:
        return Outcome(True)
    names = sorted({each.object for pair in pairs for each in (pair.first, pair.second)})
    return Outcome(False, text=say("{} pairs of faces intersect: {}").format(len(pairs), listed(names)))


def correct(context: Any, accepted: Any) -> Outcome:
    """Edit from the accepted state toward the scene as it is. What cannot be followed is tested as it is."""
    from stiv.blender import SceneChangedError, compare, follow, read_state

    changes = compare(accepted, read_state(context))
    if changes.obstacle or not changes.changes:
        return _tested_instead(context, changes.obstacle)
    try:
        followed = follow(context, _settings(context), accepted, changes)
    except (ValueError, SceneChangedError) as error:
        return _tested_instead(context, str(error))
    if not followed.corrected:
        return Outcome(True)
    told = say("corrected {}").format(listed(followed.names))
    if followed.blocking:
        told = say("corrected {}, in the way: {}").format(listed(followed.names), listed(followed.blocking))
    return Outcome(True, True, told)


def listed(names: Any, most: int = 3) -> str:
    """Some names, and how many more there are."""
    shown = ", ".join(list(names)[:most])
    return say("{} and {} more").format(shown, len(names) - most) if len(names) > most else shown


def _tested_instead(context: Any, reason: str) -> Outcome:
    """The scene as it is, if free; otherwise why it could not be corrected."""
    found = test(context)
    if found.free or not reason:
        return found
    return Outcome(False, text=say("{}; not corrected: {}").format(found.text, reason))


def _settings(context: Any) -> Any:
    """The scene's, with interference on whatever drags do."""
    return replace(edit_settings(context.scene), interference=True)
