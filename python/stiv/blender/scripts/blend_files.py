# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens, saves and renders .blend files; scripts in them are never run."""

from __future__ import annotations

from pathlib import Path

import bpy

from stiv import InputError


def open_blend(path: Path) -> bpy.types.Context:
    """Makes `path` the open file and returns Blender's context. Raises InputError if Blender cannot read it."""
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.resolve()), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot open it: {_reason(error)}") from error
    return bpy.context


def save_blend(path: Path) -> None:
    """Saves a copy of the open file, compressed. Raises InputError if Blender cannot write it."""
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(path.resolve()), compress=True, copy=True, check_existing=False)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot write it: {_reason(error)}") from error


def render_picture(path: Path) -> None:
    """Renders the open scene's current frame with the scene's own settings to a PNG file."""
    render = bpy.context.scene.render
    if bpy.context.scene.camera is None:
        raise InputError("the scene has no camera to render with")
    before = render.filepath, render.image_settings.file_format
    render.filepath, render.image_settings.file_format = str(path.resolve()), "PNG"
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        raise InputError(f"{path}: Blender cannot render it: {_reason(error)}") from error
    finally:
        render.filepath, render.image_settings.file_format = before


def _reason(error: RuntimeError) -> str:
    """Blender's own words, without its prefix."""
    return str(error).strip().removeprefix("Error: ")
