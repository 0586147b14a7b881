# SPDX-License-Identifier: GPL-3.0-or-later
"""Which events turn, pan or zoom the view: they are left to Blender during a drag."""

from __future__ import annotations

from .events import Event

WHEEL = frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE"})
OTHERS = frozenset({"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM"})


def navigates(event: Event) -> bool:
    """Whether an event belongs to the view."""
    return event.type in WHEEL or event.type in OTHERS or event.type.startswith("NDOF_")
