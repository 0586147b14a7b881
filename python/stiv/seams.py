# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams: vertices of one mesh at the same position, which connect its faces without being shared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stiv.arrays import Floats, Indices

Flags = NDArray[np.bool_]
Codes = NDArray[np.uint64]
CELL = 32  # width of a cell of the grid that finds close vertices, in distances


@dataclass(frozen=True)
class Seams:
    """The vertices of a mesh that count as one.

    Attributes:
        index: joined vertex of each vertex, (n,).
        first: the first vertex of each joined vertex, (k,), ascending.
    """

    index: Indices
    first: Indices

    @staticmethod
    def of(leaders: Indices) -> Seams | None:
        """From the first vertex that each vertex is joined with, (n,), or itself; None if there is no seam."""
        leads = leaders == np.arange(len(leaders))
        if leads.all():
            return None
        place = np.cumsum(leads, dtype=np.int32) - 1
        return Seams(place[leaders].astype(np.int32), np.flatnonzero(leads).astype(np.int32))

    @property
    def leaders(self) -> Indices:
        """The first vertex that each vertex is joined with, (n,)."""
        return self.first[self.index]

    def limited_to(self, included: Flags) -> Seams | None:
        """The seams among the given vertices, (n,) bool. The other vertices are not joined."""
        own = np.arange(len(self.index), dtype=np.int32)
        first = np.full(len(self.first), len(own), np.int32)
        np.minimum.at(first, self.index[included], own[included])
        return Seams.of(np.where(included, first[self.index], own).astype(np.int32))

    def limited_to_equal(self, values: NDArray[np.floating], tolerance: float) -> Seams | None:
        """The seams among vertices whose values, (n, ...), differ by at most a tolerance; a seam may be divided."""
        own = np.arange(len(self.index), dtype=np.int32)
        leaders, waiting = own.copy(), np.flatnonzero(np.bincount(self.index)[self.index] > 1)
        while len(waiting):  # the first copy takes those equal to it; then the next one, those that are left
            first = np.full(len(self.first), len(own), np.int32)
            np.minimum.at(first, self.index[waiting], own[waiting])
            chosen = first[self.index[waiting]]
            apart = np.abs(values[waiting] - values[chosen]).reshape(len(waiting), -1)
            equal = (apart <= tolerance).all(axis=1) | (chosen == waiting)
            leaders[waiting[equal]] = chosen[equal]
            waiting = waiting[~equal]
        return Seams.of(leaders)


def common_seams(one: Seams | None, other: Seams | None) -> Seams | None:
    """The seams that two shapes of the same mesh have in common."""
    if one is None or other is None:
        return None
    both = one.index.astype(np.int64) * len(other.first) + other.index
    _, first, index = np.unique(both, return_index=True, return_inverse=True)
    return Seams.of(first[index.reshape(-1)].astype(np.int32))


def find_seams(positions: NDArray[np.floating], triangles: Indices, rounding: float = 0.0) -> Seams | None:
    """Find the vertices of a mesh at exactly the same position; -0.0 equals 0.0.

    positions  (n, 3)
    triangles  (f, 3)
    rounding   vertices on open edges may differ by this fraction of the largest extent of the mesh along an axis, and
               by one unit in the last place of the largest coordinate

    Returns None if there are none.
    """
    leaders = _coincident(positions)
    if rounding > 0 and len(triangles):
        leaders = _rounded(positions, leaders, triangles, rounding)
    return Seams.of(leaders)


def object_seams(positions: NDArray[np.floating], triangles: Indices, owners: Indices) -> Seams | None:
    """Find the seams within each of several objects on the same vertices.

    owners  (f,) the object of each triangle; vertices of two objects are not joined
    """
    first = np.full(len(positions), np.iinfo(np.int32).max, np.int32)
    last = np.full(len(positions), -1, np.int32)
    np.minimum.at(first, triangles, owners[:, None])
    np.maximum.at(last, triangles, owners[:, None])
    return group_seams(positions, np.where(first == last, first, -1))


def group_seams(positions: NDArray[np.floating], groups: Indices) -> Seams | None:
    """Find vertices of the same group, (n,), at exactly the same position. Those of group -1 are not joined."""
    leaders = _coincident(positions)
    own = np.arange(len(leaders), dtype=np.int32)
    if np.array_equal(leaders, own):
        return None
    keys = leaders.astype(np.int64) * (int(groups.max()) + 1) + groups
    _, first, index = np.unique(keys, return_index=True, return_inverse=True)
    return Seams.of(np.where(groups < 0, own, first[index.reshape(-1)]).astype(np.int32))


def seam_pairs(seams: Seams | None, triangles: Indices, faces: Indices) -> Indices:
    """Return the pairs of faces, (k, 2), that touch along a seam: smaller number first, sorted.

    triangles  (f, 3) vertices of the mesh
    faces      (f,) the face that each triangle belongs to

    The faces have different vertices at the same position. Triangles with two corners at one position are ignored.
    """
    if seams is None or len(triangles) == 0:
        return np.empty((0, 2), np.int32)
    joined = seams.index[triangles]
    proper = (joined != np.roll(joined, 1, axis=1)).all(axis=1)
    doubled = np.bincount(seams.index, minlength=len(seams.first)) > 1
    rows = proper[:, None] & doubled[joined]
    order = np.argsort(joined[rows], kind="stable")
    owners = np.broadcast_to(faces[:, None].astype(np.int64), joined.shape)[rows][order]
    vertices = triangles[rows][order]
    found = [np.empty(0, np.int64)]
    for one, other in _in_groups(joined[rows][order]):
        apart = (vertices[one] != vertices[other]) & (owners[one] != owners[other])
        a, b = owners[one[apart]], owners[other[apart]]
        found.append(np.minimum(a, b) << 32 | np.maximum(a, b))
    keys = np.unique(np.concatenate(found))
    return np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1).astype(np.int32)


def _coincident(positions: NDArray[np.floating]) -> Indices:
    """The first vertex at exactly the same position as each, (n,)."""
    own = np.arange(len(positions), dtype=np.int32)
    places = np.ascontiguousarray(positions + positions.dtype.type(0))  # -0.0 becomes 0.0
    words = places.view(np.uint32 if places.dtype == np.float32 else np.uint64).reshape(len(places), 3)
    codes = _mixed(words.astype(np.uint64))
    ordered = np.sort(codes)
    if not (ordered[1:] == ordered[:-1]).any():
        return own
    order = np.argsort(codes, kind="stable")
    same = (places[order[1:]] == places[order[:-1]]).all(axis=1)
    if (same != (codes[order[1:]] == codes[order[:-1]])).any():  # different positions with the same code
        order = np.lexsort((own, *places.T))
        same = (places[order[1:]] == places[order[:-1]]).all(axis=1)
    begins = np.append(True, ~same)
    leaders = np.empty_like(own)
    leaders[order] = own[order[begins]][np.cumsum(begins) - 1]
    return leaders


def _mixed(words: Codes) -> Codes:
    """A hash of each row, (n,)."""
    codes = np.zeros(len(words), np.uint64)
    for column in words.T:
        codes = (codes ^ column) * np.uint64(0x9E3779B97F4A7C15)
        codes ^= codes >> np.uint64(29)
    return codes


def _rounded(positions: NDArray[np.floating], leaders: Indices, triangles: Indices, rounding: float) -> Indices:
    """Leaders, (n,), with one leader for open vertices that are within rounding of each other."""
    largest = np.abs(positions).max()
    columns = np.ascontiguousarray(positions.T)  # reductions of rows of three are slow
    extent = float((columns.max(axis=1) - columns.min(axis=1)).max())
    distance = rounding * extent + float(np.spacing(largest))
    vertices = _open_vertices(triangles, leaders)
    places = positions[vertices].astype(np.float64)
    found = np.arange(len(vertices))
    for one, other in _near(places, distance):
        lower = np.minimum(found[one], found[other])
        np.minimum.at(found, one, lower)
        np.minimum.at(found, other, lower)
    found = found[found]
    near = (np.abs(places - places[found]) <= distance).all(axis=1) & (found[found] == found)
    near &= np.bincount(found, ~near, len(found))[found] == 0  # only groups in which all are close
    result = leaders.copy()
    result[vertices[near]] = vertices[found[near]]
    joined: Indices = result[leaders]
    return joined


def _open_vertices(triangles: Indices, leaders: Indices) -> Indices:
    """The leaders of vertices whose triangles do not form a closed fan.

    In a closed fan, each neighbor follows one triangle and precedes another, so the sums of their codes cancel.
    """
    sums = np.zeros(len(leaders))
    corners = np.ascontiguousarray(triangles.T, np.intp)  # columns of rows of three are slow
    codes = [_random_codes(len(leaders)).take(corner) for corner in corners]
    for k in range(3):
        sums += np.bincount(corners[k], codes[k - 2] - codes[k - 1], len(leaders))
    is_open = np.zeros(len(leaders), np.bool_)
    is_open[leaders[np.flatnonzero(sums)]] = True
    return np.flatnonzero(is_open).astype(np.int32)


@lru_cache(maxsize=4)
def _random_codes(count: int) -> Floats:
    codes = np.random.default_rng(0).integers(1, 1 << 40, count).astype(np.float64)  # sums are exact
    codes.setflags(write=False)
    return codes


def _near(places: Floats, distance: float) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of positions, (b, 3), within a distance along each axis; in a close group, only pairs with its first."""
    codes, numbers = _crowded(*_cells(places, distance))
    while len(codes):  # pair the first of each cell with the others; then repeat without it and those near it
        begins = np.append(True, codes[1:] != codes[:-1])
        heads = numbers[begins][np.cumsum(begins) - 1]
        near = (np.abs(places[numbers] - places[heads]) <= distance).all(axis=1)
        joins = near & ~begins
        yield heads[joins], numbers[joins]
        codes, numbers = _crowded(codes[~near], numbers[~near])


def _crowded(codes: Codes, numbers: Indices) -> tuple[Codes, Indices]:
    """Sorted codes and numbers of cells with several positions."""
    ordered = np.sort(codes)
    if not (ordered[1:] == ordered[:-1]).any():
        return codes[:0], numbers[:0]
    order = np.lexsort((numbers, codes))
    codes, numbers = codes[order], numbers[order]
    same = codes[1:] == codes[:-1]
    crowded = np.append(False, same) | np.append(same, False)
    return codes[crowded], numbers[crowded]


def _cells(places: Floats, distance: float) -> tuple[Codes, Indices]:
    """Codes of the grid cells within a distance of each position, and the number of the position."""
    cells = places / (CELL * distance)
    low, high = np.floor(cells - 1 / CELL).astype(np.int64), np.floor(cells + 1 / CELL).astype(np.int64)
    apart = low != high
    codes, numbers = [], []
    for corner in range(8):
        upper = np.array([corner & 1, corner & 2, corner & 4], np.bool_)
        reaching = np.flatnonzero(apart[:, upper].all(axis=1)).astype(np.int32)
        codes.append(_mixed(np.where(upper, high[reaching], low[reaching]).astype(np.uint64)))
        numbers.append(reaching)
    return np.concatenate(codes), np.concatenate(numbers)


def _in_groups(groups: Indices) -> Iterator[tuple[Indices, Indices]]:
    """All pairs of indices of equal entries in a sorted list."""
    ends = np.searchsorted(groups, groups, side="right")
    one = np.arange(len(groups), dtype=np.int32)
    for offset in range(1, len(groups)):
        one = one[one + offset < ends[one]]
        if len(one) == 0:
            return
        yield one, one + np.int32(offset)
