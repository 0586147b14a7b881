# SPDX-License-Identifier: GPL-3.0-or-later
"""Consecutive readings of a scene share one surface as long as its connectivity and its bodies stay the same."""

from __future__ import annotations

import weakref
from collections.abc import Sequence

import numpy as np

import stiv
from stiv.blender.scene.arrays import Indices

_latest: weakref.ref[stiv.Surface] | None = None  # the session of an edit keeps it alive


def make_surface(
    triangles: Indices,
    vertex_count: int,
    loose_edges: Indices,
    vertex_body: Indices,
    bodies: Sequence[stiv.Body] | None,
    ignored: Sequence[tuple[int, int]],
) -> stiv.Surface:
    """Make a surface, or return the latest one that still exists if it would be equal, which saves finding edges."""
    global _latest
    latest = None if _latest is None else _latest()
    if latest is not None:
        same_bodies = bodies is not None and latest.bodies == tuple(bodies)
        same_pairs = np.array_equal(latest.ignored, np.reshape(np.asarray(ignored, np.int32), (-1, 2)))
        connected = (latest.triangles, latest.loose_edges, latest.vertex_body)
        if (
            latest.vertex_count == vertex_count and same_bodies and same_pairs and not latest.flip_faces
            and _all_equal(connected, (triangles, loose_edges, vertex_body))
        ):  # fmt: skip
            return latest
    made = stiv.Surface(triangles, vertex_count, loose_edges, vertex_body, bodies, ignored)
    _latest = weakref.ref(made)
    return made


def are_equal(one: stiv.Surface, other: stiv.Surface) -> bool:
    """Have two surfaces the same connectivity and the same bodies?"""
    if one is other:
        return True
    plain = one.vertex_count == other.vertex_count and one.bodies == other.bodies and one.flip_faces == other.flip_faces
    return plain and _all_equal(_arrays(one), _arrays(other))


def _arrays(surface: stiv.Surface) -> tuple[Indices, ...]:
    return surface.triangles, surface.loose_edges, surface.vertex_body, surface.ignored


def _all_equal(ours: Sequence[Indices], theirs: Sequence[Indices]) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(ours, theirs, strict=True))
