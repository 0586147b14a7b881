# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches deformations between drags, as long as their inputs stay the same."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import stiv
from stiv.blender.scene.arrays import digest

MAX_ENTRIES = 3  # deformations; the weights of one take about a kilobyte for each vertex

_cache: OrderedDict[bytes, stiv.Deformation] = OrderedDict()


def cached_deformation(make: Callable[..., stiv.Deformation], *inputs: Any, **options: Any) -> stiv.Deformation:
    """Call `make` with these arrays and plain values, or return the cached result of an equal call."""
    key = digest(make.__qualname__, *inputs, *options, *options.values())
    if key not in _cache:
        _cache[key] = make(*inputs, **options)
    _cache.move_to_end(key)
    while len(_cache) > MAX_ENTRIES:
        _cache.popitem(last=False)
    return _cache[key]


def clear_cache() -> None:
    """Clear the cache."""
    _cache.clear()
