# SPDX-License-Identifier: GPL-3.0-or-later
"""STIV: move, rotate and scale in Blender without intersections.

operators: one in each file; modal: the state machine of a drag, without bpy; transform: from pointer and numbers to
matrices; scene: reads Blender's settings; guard, overlay, panels. The package `stiv` reads, solves and writes geometry.
"""


def register() -> None:
    """Called by Blender when the extension is enabled."""
    from . import registration  # modal and transform can be imported without Blender

    registration.register()


def unregister() -> None:
    """Called by Blender when the extension is disabled."""
    from . import registration

    registration.unregister()
