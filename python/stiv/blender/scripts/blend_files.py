# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens, saves and renders .blend files; never runs scripts in them."""

from __future__ import annotations

from pathlib import Path

import bpy

from stiv import InputError
from stiv.output_files import resolved


def open_blend(path: Path) -> bpy.types.Context:
    """Open a file and return Blender's context. Raises InputError if Blender cannot read it."""
    try:
        bpy.ops.wm.open_mainfile(filepath=str(resolved(path)), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot open it: {_reason(error)}") from error
    return bpy.context


def save_blend(path: Path) -> None:
    """Save a compressed copy of the open file. Raises InputError if Blender cannot write it."""
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(resolved(path)), compress=True, copy=True, check_existing=False)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot write it: {_reason(error)}") from error


def render_picture(path: Path) -> None:
    """Render the current frame of the open scene, with its own settings, to a PNG file."""
    render = bpy.context.scene.render
    if bpy.context.scene.camera is None:
        raise InputError("the scene has no camera to render with")
    before = render.filepath, render.image_settings.file_format
    render.filepath, render.image_settings.file_format = str(resolved(path)), "PNG"
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot render it: {_reason(error)}") from error
    finally:
        render.filepath, render.image_settings.file_format = before


def _reason(error: RuntimeError) -> str:
    """Blender's message without its prefix."""
    return str(error).strip().removeprefix("Error: ")
