# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the Blender layer that are not about input values."""


class SceneChangedError(RuntimeError):
    """An object of a running edit is gone, or its mode or size has changed; the edit has to be cancelled."""
