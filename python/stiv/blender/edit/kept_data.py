# SPDX-License-Identifier: GPL-3.0-or-later
"""Frees what edits keep for the next one: it may take as much memory as the scene."""

from stiv.blender.controls.deformation_cache import clear_cache
from stiv.blender.edit.kept_session import forget_session
from stiv.blender.scene.static_reading import forget_static_meshes


def free_kept_data() -> None:
    """Free the session of the last edit, its obstacles, and deformations. A running edit keeps its own."""
    forget_session()
    forget_static_meshes()
    clear_cache()
