# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges of frames: `1:120`, `1:120:2`, or `scene`."""

from __future__ import annotations

LIMIT = 2**20  # Blender's own


def parse_frames(text: str) -> tuple[int, int, int] | str:
    """First frame, last frame and step, or "scene". Raises ValueError."""
    if text == "scene":
        return text
    try:
        numbers = [int(number) for number in text.split(":")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3):
        raise ValueError(f"frames {text!r} are not of the form A:B, A:B:STEP or scene")
    first, last, step = (*numbers, 1)[:3]
    if not -LIMIT <= first <= last <= LIMIT or step < 1:
        raise ValueError(f"frames {text!r} must ascend, by a step of 1 or more, between {-LIMIT} and {LIMIT}")
    return first, last, step
