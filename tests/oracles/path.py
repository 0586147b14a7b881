# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts along a linear step, found with sorted boxes instead of trees and root finding.

Two convex sets are disjoint if some direction separates them. Along a fixed direction, the difference of two
vertices in linear motion is linear in time, so its values at the ends of an interval bound all others. A
direction that separates at both ends thus proves the whole interval clear. The choice of directions affects
the speed but not the result. If an interval shorter than RESOLUTION cannot be proven clear, a contact is
reported.
"""

import itertools
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

RESOLUTION = 2.0**-26
GUARD = 2.0**-45  # relative to the extent: more than 100 times the rounding error of one height
ROWS = 4096  # pairs examined at a time, to limit the memory
PAIRS = 1_000_000  # boxes compared at a time


class Contacts(NamedTuple):
    """Pairs in contact, or too close to decide, sorted by kind and vertices."""

    kind: list[str]
    """ "vf" or "ee" """
    vertices: Integers
    """(K, 4): v, a, b, c of a vertex and a face; a0, a1, b0, b1 of two edges"""
    time: Floats
    """(K,) never later than the first contact, and at most RESOLUTION earlier than something unresolved"""


def find_contacts(
    triangles: ArrayLike,
    start: ArrayLike,
    end: ArrayLike,
    separation: float = 0.0,
    keep: float = 0.5,
    *,
    reference: ArrayLike | None = None,
    loose_edges: ArrayLike = (),
    vertex_body: ArrayLike | None = None,
    meets: ArrayLike | None = None,
    flip_faces: Iterable[Iterable[int]] = (),
) -> Contacts:
    """Return all vertex-face and edge-edge pairs that come too close along a linear step.

    triangles    (F, 3), loose_edges (L, 2); pairs that share a vertex are omitted
        start, end   (N, 3)
    separation   minimum distance of pairs that are at least as far apart at the reference; for others, the fraction
                     `keep` of their distance there; for pairs that start closer, their distance at the start
        reference    (N, 3), the start if not given
        vertex_body  (N,) with meets (B, B) bool: which bodies are tested against each other
    flip_faces  vertices of faces with several triangulations; pairs within one of them are omitted
    """
    first, last = np.asarray(start, np.float64), np.asarray(end, np.float64)
    centre = (first.min(axis=0) + first.max(axis=0)) / 2 if len(first) else 0
    before = (first if reference is None else np.asarray(reference, np.float64)) - centre
    first, last = first - centre, last - centre
    extent = max(np.abs(first).max(initial=0), np.abs(last).max(initial=0))
    guard = GUARD * extent
    body = np.zeros(len(first), int) if vertex_body is None else np.asarray(vertex_body)
    allowed = np.ones((body.max(initial=0) + 1,) * 2, bool) if meets is None else np.asarray(meets)
    kinds: list[str] = []
    vertices, times = [np.empty((0, 4), int)], [np.empty(0)]
    for kind, pairs in _pairs_in_reach(np.asarray(triangles), loose_edges, first, last, separation + guard):
        kept = pairs[allowed[body[pairs[:, 0]], body[pairs[:, 3]]]]
        for face in flip_faces:
            kept = kept[~np.isin(kept, list(face)).all(axis=1)]
        time = first_contacts(kind, first[kept], last[kept], before[kept], separation, keep, guard)
        met = np.isfinite(time)
        kinds += [kind] * int(met.sum())
        vertices.append(kept[met])
        times.append(time[met])
    return Contacts(kinds, np.concatenate(vertices), np.concatenate(times))


def unique_edges(triangles: ArrayLike, loose_edges: ArrayLike = ()) -> Integers:
    faces = np.asarray(triangles, int).reshape(-1, 3)
    sides = [faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]], np.asarray(loose_edges, int).reshape(-1, 2)]
    edges = np.unique(np.sort(np.concatenate(sides), axis=1), axis=0)
    return edges[edges[:, 0] != edges[:, 1]]


def first_contacts(
    kind: str, start: Floats, end: Floats, reference: Floats, separation: float, keep: float, guard: float
) -> Floats:
    """Return for pairs (M, 4, 3) the start of the first interval not proven clear, inf if there is none."""
    time = np.full(len(start), np.inf)
    for begin in range(0, len(start), ROWS):
        part = slice(begin, begin + ROWS)
        first, last = _outline(kind, start[part]), _outline(kind, end[part])
        kept = kept_distances(_distances(_outline(kind, reference[part])), separation, keep)
        time[part] = _march(first, last, guard + np.minimum(kept, _distances(first)))
    return time


def kept_distances(distances: Floats, separation: float, keep: float) -> Floats:
    """Return the minimum distances of pairs with these distances at the reference."""
    return np.where(distances >= (1 - 2.0**-24) * separation, separation, keep * distances)


def _pairs_in_reach(
    triangles: Integers, loose_edges: ArrayLike, start: Floats, end: Floats, clearance: float
) -> Iterator[tuple[str, Integers]]:
    """Yield pairs (K, 4) of primitives whose swept boxes come within the clearance, in batches."""
    edges = unique_edges(triangles, loose_edges)
    faces = triangles.reshape(-1, 3)
    for kind, queries, others in (("vf", np.arange(len(start))[:, None], faces), ("ee", edges, edges)):
        boxes, other_boxes = _swept_boxes(queries, start, end), _swept_boxes(others, start, end)
        for i, j in _overlapping(boxes, other_boxes, clearance):
            if kind == "ee":
                i, j = i[i < j], j[i < j]
            pairs = np.concatenate([queries[i], others[j]], axis=1)
            width = queries.shape[1]
            shares = (pairs[:, :width, None] == pairs[:, None, width:]).any(axis=(1, 2))
            yield kind, pairs[~shares]


def _overlapping(
    boxes: tuple[Floats, Floats], others: tuple[Floats, Floats], clearance: float
) -> Iterator[tuple[Integers, Integers]]:
    """Yield the rows of all boxes (low, high) that come within the clearance of each other.

    Along one axis, boxes that overlap a query begin below its end, and at most the largest width below its
    start.
    """
    (low, high), (others_low, others_high) = boxes, others
    if not len(low) or not len(others_low):
        return
    axis = int(np.argmax(others_low.std(axis=0) / np.maximum(np.median(others_high - others_low, axis=0), 1e-300)))
    order = np.argsort(others_low[:, axis], kind="stable")
    begins = others_low[order, axis]
    widest = (others_high - others_low)[:, axis].max()
    first = np.searchsorted(begins, low[:, axis] - 2 * clearance - widest, "left")
    count = np.searchsorted(begins, high[:, axis] + 2 * clearance, "right") - first
    for part in _slices(count, PAIRS):
        i = np.repeat(np.arange(len(low))[part], count[part])
        within = np.arange(len(i)) - np.repeat(np.cumsum(count[part]) - count[part], count[part])
        j = order[np.repeat(first[part], count[part]) + within]
        for k in (axis, *{0, 1, 2}.difference([axis])):
            near = low[i, k] - clearance <= others_high[j, k]
            near &= high[i, k] + clearance >= others_low[j, k]
            i, j = i[near], j[near]
        yield i, j


def _slices(sizes: Integers, most: int) -> Iterator[slice]:
    """Yield slices of consecutive rows whose sizes add up to about `most`."""
    cuts = np.flatnonzero(np.diff(np.cumsum(sizes) // most)) + 1
    borders = [0, *cuts.tolist(), len(sizes)]
    yield from (slice(begin, end) for begin, end in itertools.pairwise(borders) if end > begin)


def _swept_boxes(primitives: Integers, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Return low and high corners, (P, 3) each, of the swept primitives."""
    corners = np.concatenate([start[primitives], end[primitives]], axis=1)
    return corners.min(axis=1), corners.max(axis=1)


def _outline(kind: str, x: Floats) -> Floats:
    """Return the differences of the two sides' vertices, (M, 3 or 4, 3), in order around their convex hull.

    The primitives touch if that triangle or parallelogram contains the origin; its distance is theirs.
    """
    if kind == "vf":
        return x[:, :1] - x[:, 1:]
    return x[:, [0, 0, 1, 1]] - x[:, [2, 3, 3, 2]]


def _directions(outline: Floats) -> Floats:
    """Return unit directions (M, D, 3), among them that from the origin to the nearest point of the outline's
    hull.

    The nearest point is a corner, lies on an edge, or lies inside.
    """
    sides = np.roll(outline, -1, axis=1) - outline
    length = np.maximum((sides**2).sum(axis=2, keepdims=True), np.finfo(float).tiny)
    over_edges = outline - sides * ((outline * sides).sum(axis=2, keepdims=True) / length)
    normal = np.cross(sides[:, :1], sides[:, 1:2])
    found = np.concatenate([outline, over_edges, normal], axis=1)
    return found / np.maximum(np.linalg.norm(found, axis=2, keepdims=True), np.finfo(float).tiny)


def _distances(outline: Floats) -> Floats:
    """Return the distance of the origin from the hull of each outline (M, m, 3)."""
    heights = outline @ _directions(outline).transpose(0, 2, 1)
    return np.maximum(np.maximum(heights.min(axis=1), -heights.max(axis=1)).max(axis=1), 0)


def _proven_free(begin: Floats, end: Floats, clearance: Floats) -> NDArray[np.bool_]:
    """Tell for which outlines (M, m, 3) in linear motion some fixed direction separates them from the origin."""
    directions = _directions((begin + end) / 2).transpose(0, 2, 1)
    heights = np.concatenate([begin @ directions, end @ directions], axis=1)
    apart = np.maximum(heights.min(axis=1), -heights.max(axis=1)).max(axis=1)
    return apart > clearance


def _march(start: Floats, end: Floats, clearance: Floats) -> Floats:
    """Advance each pair from time 0 by intervals proven clear: halved after a failure, doubled after a success."""
    contact = np.full(len(start), np.inf)
    row, time, width = np.arange(len(start)), np.zeros(len(start)), np.ones(len(start))
    while len(row):
        ends = [start[row] + t[:, None, None] * (end[row] - start[row]) for t in (time, time + width)]
        free = _proven_free(ends[0], ends[1], clearance[row])
        time = np.where(free, time + width, time)
        width = np.where(free, np.minimum(2 * width, 1 - time), width / 2)
        stuck = ~free & (width < RESOLUTION)
        contact[row[stuck]] = time[stuck]
        unfinished = ~stuck & (time < 1)
        row, time, width = row[unfinished], time[unfinished], width[unfinished]
    return contact
