# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of `execute`, for which Blender waits without events that could cancel it: of the redo panel, of scripts."""

from __future__ import annotations

import time
from typing import TypeVar

import bpy

from ... import stiv_blender
from .. import window_io

Result = TypeVar("Result")

LIMIT = 5  # seconds; then the part of the way that is solved stays


def is_redo(operator: bpy.types.Operator) -> bool:
    """Whether the redo panel calls `execute`. Scripts have the operator's own limit, drags none."""
    return bool(operator.options.is_repeat) and not bpy.app.background


def run_within(context: bpy.types.Context, steps: stiv_blender.Steps[Result], seconds: float) -> tuple[Result, bool]:
    """Make all calls of the steps behind the wait cursor; after these seconds they are cancelled.

    Returns the result, and whether calls were cancelled.
    """
    end = time.monotonic() + seconds
    token = stiv_blender.CancelToken()

    def look_at_clock(*_progress: object) -> None:
        if time.monotonic() > end:
            token.cancel()

    window_io.show_wait_cursor(context, True)
    try:
        return stiv_blender.run_steps(steps, cancel=token, progress=look_at_clock), token.cancelled
    finally:
        window_io.show_wait_cursor(context, False)
