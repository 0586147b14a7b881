# SPDX-License-Identifier: GPL-3.0-or-later
"""STIV: move, rotate and scale in Blender without intersections.

operators: one a file over a shared adapter; modal: the state machine of a drag, without bpy; transform: from pointer
and numbers to matrices; the rest is interface. Geometry is read, solved and written by the package `stiv`.
"""


def register() -> None:
    """Called by Blender when the extension is enabled."""
    from . import registration  # so that the parts without bpy can be imported where there is no Blender

    registration.register()


def unregister() -> None:
    """Called by Blender when the extension is disabled."""
    from . import registration

    registration.unregister()
