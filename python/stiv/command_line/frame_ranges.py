# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges of frames on the command line: `1:120`, `1:120:2`, or `scene`."""

from __future__ import annotations

import argparse

LIMIT = 2**20  # as Blender's own


def frame_range(text: str) -> tuple[int, int, int] | str:
    """First frame, last frame and step, or "scene". Raises what argparse takes for wrong usage."""
    if text == "scene":
        return text
    parts = text.split(":")
    try:
        numbers = [int(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form A:B, A:B:STEP or scene")
    first, last, step = (*numbers, 1)[:3]
    if not -LIMIT <= first <= last <= LIMIT or step < 1:
        raise argparse.ArgumentTypeError(f"{text!r}: the frames must ascend, by a step of 1 or more")
    return first, last, step
