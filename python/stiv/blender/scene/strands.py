# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as segments with a radius, and the closed boxes that cover them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stiv.blender.scene.arrays import Flags, Floats, Indices, transform_points

SUBDIVISION = 4  # chords for each span of a Catmull-Rom curve
BOX_FACES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
     (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)], np.int32,
)  # fmt: skip


@dataclass(frozen=True)
class Strands:
    """Segments of strands in the world.

    Attributes:
        ends: both ends of each segment, (s, 2, 3).
        radii: radius of each segment, (s,); 0 for a line.
        numbers: strand of each segment, (s,).
    """

    ends: Floats
    radii: Floats
    numbers: Indices

    def moved(self, matrix: Floats) -> Strands:
        """Transform by a matrix, (4, 4); radii grow by its largest scale."""
        ends = transform_points(matrix, self.ends.reshape(-1, 3)).reshape(-1, 2, 3)
        return Strands(ends, self.radii * float(np.linalg.norm(matrix[:3, :3], 2)), self.numbers)


@dataclass(frozen=True)
class StrandSurface:
    """The surface that covers strands.

    Attributes:
        positions: (n, 3) in the world.
        triangles: a closed box for each segment with a radius, (f, 3).
        edges: segments without a radius, (l, 2).
        numbers: strand of each vertex, (n,).
    """

    positions: Floats
    triangles: Indices
    edges: Indices
    numbers: Indices


def polyline_strands(points: Floats, counts: Indices, radii: Floats) -> Strands:
    """Polylines of `counts` points each, (k,), with stacked positions, (n, 3), and radii, (n,)."""
    numbers = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    first = np.flatnonzero(numbers[:-1] == numbers[1:])
    ends = np.stack([points[first], points[first + 1]], axis=1)
    return Strands(ends, np.maximum(radii[first], radii[first + 1]), numbers[first])


def edge_strands(points: Floats, edges: Indices) -> Strands:
    """Segments without radius; each run of edges that share vertices is a strand."""
    breaks = np.append(True, edges[1:, 0] != edges[:-1, 1])[: len(edges)]
    numbers = (np.cumsum(breaks) - 1).astype(np.int32)
    return Strands(points[edges].reshape(-1, 2, 3), np.zeros(len(edges)), numbers)


def hair_strands(points: Floats, counts: Indices, radii: Floats, smooth: Flags, cyclic: Flags) -> Strands:
    """Curves of `counts` points each, (k,): Catmull-Rom curves if `smooth`, (k,), otherwise polylines.

    The radius of a smooth curve's chord includes its distance from the curve.
    """
    numbers = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    firsts = np.repeat(np.cumsum(counts) - counts, counts)
    lasts = firsts + np.repeat(counts, counts) - 1
    place = np.arange(len(points))
    closed = cyclic[numbers] & (lasts > firsts)
    following = np.where(place < lasts, place + 1, np.where(closed, firsts, lasts))
    previous = np.where(place > firsts, place - 1, np.where(closed, lasts, firsts))
    spans = place[(place < lasts) | closed]
    values = np.concatenate([points, radii[:, None]], axis=1)
    nodes = np.stack([previous[spans], spans, following[spans], following[following[spans]]], axis=1)
    bent = smooth[numbers[spans]]
    straight = values[nodes[~bent][:, 1:3]]
    parts = [
        Strands(straight[..., :3], straight[..., 3].max(axis=1, initial=0.0), numbers[spans[~bent]]),
        _catmull_rom(values[nodes[bent]], numbers[spans[bent]]),
    ]
    return join_strands(parts)


def join_strands(parts: Sequence[Strands]) -> Strands:
    """Concatenate strands."""
    return Strands(
        np.concatenate([np.empty((0, 2, 3)), *(each.ends for each in parts)]),
        np.concatenate([np.empty(0), *(each.radii for each in parts)]),
        np.concatenate([np.empty(0, np.int32), *(each.numbers for each in parts)]),
    )


def cover_strands(strands: Strands) -> StrandSurface:
    """Cover each segment by a box that contains all points within its radius, or by an edge if the radius is 0."""
    lengths = np.linalg.norm(strands.ends[:, 1] - strands.ends[:, 0], axis=1)
    thick, thin = strands.radii > 0, (strands.radii <= 0) & (lengths > 0)
    corners = _boxes(strands.ends[thick], strands.radii[thick])
    lines = strands.ends[thin].reshape(-1, 3)
    boxes, count = len(corners), 8 * len(corners)
    return StrandSurface(
        np.concatenate([corners.reshape(-1, 3), lines]),
        (BOX_FACES[None] + 8 * np.arange(boxes, dtype=np.int32)[:, None, None]).reshape(-1, 3),
        (count + np.arange(len(lines), dtype=np.int32)).reshape(-1, 2),
        np.concatenate([np.repeat(strands.numbers[thick], 8), np.repeat(strands.numbers[thin], 2)]).astype(np.int32),
    )


def _catmull_rom(nodes: Floats, numbers: Indices) -> Strands:
    """Chords of spans, from the positions and radii of their four nodes, (s, 4, 4)."""
    a, b, c, d = (nodes[:, k] for k in range(4))
    t = np.linspace(0.0, 1.0, SUBDIVISION + 1)[:, None, None]
    values = 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
    second = np.maximum(
        np.linalg.norm(2 * a - 5 * b + 4 * c - d, axis=1), np.linalg.norm(4 * b - a - 5 * c + 2 * d, axis=1)
    )
    bend = second / (8 * SUBDIVISION**2)  # the second derivative is linear, so its maximum is at an end
    ends = np.stack([values[:-1, :, :3], values[1:, :, :3]], axis=2)
    radii = np.maximum(values[:-1, :, 3], values[1:, :, 3]) + bend
    return Strands(ends.reshape(-1, 2, 3), radii.ravel(), np.tile(numbers, SUBDIVISION))


def _boxes(ends: Floats, radii: Floats) -> Floats:
    """Corners of the boxes, (s, 8, 3)."""
    along = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.where(lengths > 0, along / np.where(lengths > 0, lengths, 1.0), (1.0, 0.0, 0.0))
    axis = np.eye(3)[np.abs(along).argmin(axis=1)]
    across = np.cross(along, axis)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    up = np.cross(along, across)
    r = radii[:, None]
    corners = [
        ends[:, i] + (2 * i - 1) * r * along + j * r * across + k * r * up
        for i in (0, 1) for j in (-1, 1) for k in (-1, 1)
    ]  # fmt: skip
    return np.stack(corners, axis=1)
