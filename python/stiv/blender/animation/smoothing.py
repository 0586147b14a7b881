# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooth corrections over time that are at least as large as needed at each frame."""

from __future__ import annotations

import numpy as np

from stiv.blender.scene.arrays import Floats


def envelope(needed: Floats, width: int, is_cyclic: bool = False) -> Floats:
    """Smooth values, (F, k), not smaller than those needed, (F, k), in either direction.

    Each value is held for `width` frames to both sides, then averaged over as many: it begins and ends within twice
    the width. is_cyclic: the last frame is the first one again.
    """
    if width == 0 or not needed.any():
        return needed.copy()
    return _one_sided(np.maximum(needed, 0), width, is_cyclic) - _one_sided(np.maximum(-needed, 0), width, is_cyclic)


def _one_sided(needed: Floats, width: int, is_cyclic: bool) -> Floats:
    count, reach = len(needed), 2 * width
    if is_cyclic and count > 1:
        needed = np.concatenate([np.maximum(needed[:1], needed[-1:]), needed[1:-1]])
        rows = np.arange(-reach, count + reach) % len(needed)
    else:
        rows = np.clip(np.arange(-reach, count + reach), 0, count - 1)
    wide = needed[rows]
    held = np.max([wide[k : len(wide) - reach + k] for k in range(reach + 1)], axis=0)
    kernel = 1 + np.cos(np.pi * np.arange(-width, width + 1) / (width + 1))
    kernel /= kernel.sum()
    smooth: Floats = sum(weight * held[k : k + count] for k, weight in enumerate(kernel.tolist()))
    return smooth


def largest_acceleration(steps: Floats, is_cyclic: bool = False) -> float:
    """Largest change between consecutive motions, (F - 1, n, 3). is_cyclic: the first one follows the last one."""
    if is_cyclic and len(steps):
        steps = np.concatenate([steps, steps[:1]])
    change = np.diff(steps, axis=0)
    return float(np.sqrt((change * change).sum(axis=2).max(initial=0.0)))
