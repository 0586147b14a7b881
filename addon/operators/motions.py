# SPDX-License-Identifier: GPL-3.0-or-later
"""From a transform to what an edit drags to."""

from __future__ import annotations

from typing import Any

from ..transform.frame import Frame


def make_motion(transform: Any, frame: Frame, influence: Any) -> Any:
    """`stiv.blender.Motion` of a transform in its frame."""
    from stiv.blender import Motion  # the add-on registers without the native module

    matrix = transform.matrix(frame)
    return Motion(matrix, frame.pivot, frame.individual, influence, rotation=transform.rotation)
