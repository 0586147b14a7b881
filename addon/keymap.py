# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of the operators, which Blender's default keymap does not use; users change them in the preferences."""

import bpy

# Shift+Alt with letters that Blender's default keymap does not use in these modes; it uses G and S.
KEYS = {"stiv.move": "M", "stiv.rotate": "R", "stiv.scale": "E", "stiv.check": "C"}
PIE_OPERATOR, PIE_MENU, PIE_KEY = "wm.call_menu_pie", "STIV_MT_pie", "Q"
# Keymaps of modes precede that of the 3D view.
KEYMAPS = ("Object Mode", "Mesh", "Lattice", "Pose", "Curve")  # the last one also of NURBS surfaces
TAKEN = {("Pose", "stiv.scale")}  # Shift+Alt+E is Blender's Blend to Neighbor there

_added: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def register() -> None:
    """Add the keys to the add-on keymaps, which exist only with a window."""
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:
        return
    for name in KEYMAPS:
        keymap = configuration.keymaps.new(name=name, space_type="EMPTY")
        for operator, key in (*KEYS.items(), (PIE_OPERATOR, PIE_KEY)):
            if (name, operator) in TAKEN:
                continue
            item = keymap.keymap_items.new(operator, key, "PRESS", shift=True, alt=True)
            if operator == PIE_OPERATOR:
                item.properties.name = PIE_MENU
            _added.append((keymap, item))


def is_ours(item: bpy.types.KeyMapItem) -> bool:
    """Whether a key belongs to the extension, also after the user changed it."""
    pie = item.idname == PIE_OPERATOR and item.properties is not None and item.properties.name == PIE_MENU
    return pie or item.idname in KEYS


def unregister() -> None:
    """Remove the keys."""
    for keymap, item in _added:
        keymap.keymap_items.remove(item)
    _added.clear()
