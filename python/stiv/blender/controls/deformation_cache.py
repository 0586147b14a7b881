# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches deformations between drags, as long as their inputs stay the same."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np

import stiv

MOST = 3  # deformations; the weights of one take about a kilobyte for each vertex

_kept: OrderedDict[bytes, stiv.Deformation] = OrderedDict()


def cached_deformation(make: Callable[..., stiv.Deformation], *inputs: Any) -> stiv.Deformation:
    """Call `make` with these arrays and plain values, or return the cached result of an equal call."""
    key = _digest(make.__qualname__, *inputs)
    if key not in _kept:
        _kept[key] = make(*inputs)
    _kept.move_to_end(key)
    while len(_kept) > MOST:
        _kept.popitem(last=False)
    return _kept[key]


def clear_cache() -> None:
    """Clear the cache."""
    _kept.clear()


def _digest(*values: Any) -> bytes:
    found = hashlib.blake2b(digest_size=20)
    for value in values:
        array = isinstance(value, np.ndarray)
        found.update(repr((value.dtype.str, value.shape) if array else value).encode() + b"\0")
        if array:
            found.update(np.ascontiguousarray(value).tobytes())
    return found.digest()
