# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts rigid bodies that intersect or are too near, by the shortest translations found."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product

import numpy as np

from stiv.blender.layout.containment import is_mostly_inside, is_outside
from stiv.blender.layout.layout_task import Watch
from stiv.blender.layout.rigid_contacts import contact_normals, is_clear, travel
from stiv.blender.layout.rigid_scene import SURPLUS, RigidScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.task import Steps

MAX_NORMALS = 48  # normals of intersecting triangles, tried as directions
REFINEMENTS = (0.2, 0.05, 0.01)  # radians around the best direction
SAMPLES = 6  # distances tried along a direction, before the one from outside
MAX_SWEEPS = 12  # over all pairs that are too near


def part(scene: RigidScene, mover: int, watch: Watch, among: Flags | None = None) -> Steps[Floats | None]:
    """Steps that translate a mover by the shortest way found to where it is clear; the translation, None without one.

    among: see `RigidScene.facing`.
    """
    if is_clear(scene, mover, among):
        return np.zeros(3)
    pose = scene.pose(mover)
    inside = yield from is_mostly_inside(scene, mover, among)
    search = _Search(scene, mover, among, watch, inside)
    for direction in _directions(scene, mover, among):
        yield from search.probe(direction)
    for angle in REFINEMENTS:
        yield from search.refine(angle)
    scene.set_pose(mover, pose)
    if search.best is None:
        return None
    scene.shift(mover, search.best)
    return search.best


def part_all(scene: RigidScene, movers: Sequence[int], watch: Watch) -> Steps[list[int]]:
    """Steps that part movers from each other and from everything else; they return those that cannot be parted.

    Both movers of a pair move by half of the way, as long as that converges; then each moves on its own.
    """
    for sweep in range(MAX_SWEEPS):
        pairs = yield from find_near_pairs(scene, movers, watch)
        if not pairs:
            break
        for number, (first, second) in enumerate(pairs):
            yield from watch.at(scene.movers[first].name, (sweep + number / len(pairs)) / (MAX_SWEEPS + 1))
            yield from _part_pair(scene, first, second, watch)
    left = []
    for number, mover in enumerate(movers):
        yield from watch.at(scene.movers[mover].name, (MAX_SWEEPS + number / len(movers)) / (MAX_SWEEPS + 1))
        if (yield from part(scene, mover, watch)) is None:
            left.append(mover)
    return left


def find_near_pairs(scene: RigidScene, movers: Sequence[int], watch: Watch) -> Steps[list[tuple[int, int]]]:
    """Steps that find the pairs of movers that are too near; (mover, -1) for a mover and anything else."""
    others = _others(scene, movers)
    tested = [(a, b, _only(scene, b)) for a, b in combinations(movers, 2) if _boxes_near(scene, a, b)]
    pairs = []
    for a, b, among in [*tested, *((a, -1, others) for a in movers)]:
        yield from watch.check()
        if not is_clear(scene, a, among):
            pairs.append((a, b))
    return pairs


def _part_pair(scene: RigidScene, first: int, second: int, watch: Watch) -> Steps[None]:
    if second < 0:
        yield from part(scene, first, watch, _others(scene, range(len(scene.movers))))
        return
    start = scene.pose(first)
    way = yield from part(scene, first, watch, _only(scene, second))
    if way is None or not way.any():
        return
    half = scene.movers[second].along_free(-way / 2)
    scene.set_pose(first, start)
    scene.shift(second, half)
    scene.shift(first, way + half)


def _only(scene: RigidScene, mover: int) -> Flags:
    flags = np.zeros(len(scene.movers) + 1, np.bool_)
    flags[mover] = True
    return flags


def _others(scene: RigidScene, movers: Sequence[int]) -> Flags:
    flags = np.ones(len(scene.movers) + 1, np.bool_)
    flags[list(movers)] = False
    return flags


def _boxes_near(scene: RigidScene, a: int, b: int) -> bool:
    first, second, reach = scene.box(a), scene.box(b), scene.largest_separation
    return bool((first[0] <= second[1] + reach).all() and (second[0] <= first[1] + reach).all())


class _Search:
    """The shortest clear translation among the directions probed so far."""

    def __init__(self, scene: RigidScene, mover: int, among: Flags | None, watch: Watch, inside: bool) -> None:
        self._scene, self._mover, self._among, self._watch = scene, mover, among, watch
        self._start = scene.pose(mover)
        self._outside = self._distance_outside()
        self._may_stay_inside = inside
        self.best: Floats | None = None

    def probe(self, direction: Floats) -> Steps[None]:
        """Steps that find the shortest clear translation along a direction, if it is shorter than the best one."""
        yield from self._watch.check()
        direction = self._scene.movers[self._mover].along_free(direction)
        length = float(np.linalg.norm(direction))
        if length < 1e-6:
            return
        direction = direction / length
        longest = self._outside if self.best is None else float(np.linalg.norm(self.best)) * (1 - 1e-9)
        for distance in self._distances(longest):
            self._place(distance * direction)
            if (yield from self._is_clear()):
                yield from self._shorten(direction, distance)
                return

    def refine(self, angle: float) -> Steps[None]:
        """Steps that probe directions around the best one."""
        if self.best is None:
            return
        direction = self.best / np.linalg.norm(self.best)
        across = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
        across /= np.linalg.norm(across)
        for turn in np.arange(6) * np.pi / 3:
            side = np.cos(turn) * across + np.sin(turn) * np.cross(direction, across)
            yield from self.probe(direction + angle * side)

    def _distances(self, longest: float) -> Floats:
        """Distances to try, rising: only the longest for a body that must stay outside."""
        if not self._may_stay_inside:
            return np.array([longest])
        return np.geomspace(min(2 * self._scene.separation, longest), longest, SAMPLES)

    def _is_clear(self) -> Steps[bool]:
        if not is_clear(self._scene, self._mover, self._among):
            return False
        return self._may_stay_inside or (yield from is_outside(self._scene, self._mover, self._among))

    def _shorten(self, direction: Floats, distance: float) -> Steps[None]:
        """Steps that travel back from a clear place as far as the minimum distance allows."""
        fraction = yield from travel(self._scene, self._mover, -distance * direction, self._among)
        kept = distance * (1 - (1.0 if fraction is None else fraction)) + SURPLUS * self._scene.separation
        self._place(kept * direction)
        if not is_clear(self._scene, self._mover, self._among):
            kept = distance
        if self.best is None or kept < np.linalg.norm(self.best):
            self.best = kept * direction

    def _place(self, vector: Floats) -> None:
        pose = self._start.copy()
        pose[0] += vector
        self._scene.set_pose(self._mover, pose)

    def _distance_outside(self) -> float:
        """A translation of this length leaves the box of everything, in any direction."""
        both = np.concatenate([self._scene.extent_among(self._mover, self._among), self._scene.box(self._mover)])
        return float(np.linalg.norm(np.ptp(both, axis=0))) + 2 * self._scene.largest_separation


def _directions(scene: RigidScene, mover: int, among: Flags | None) -> list[Floats]:
    """The 26 directions to the neighbors in a grid, and the normals of triangles that intersect."""
    grid = [np.array(each, np.float64) for each in product((0, 1, -1), repeat=3) if any(each)]
    grid.sort(key=lambda each: (np.abs(each).sum(), each.tolist() != [0, 0, 1]))
    found = [each / np.linalg.norm(each) for each in grid]
    normals = contact_normals(scene, mover, among)
    _, first = np.unique(np.round(normals, 3), axis=0, return_index=True)
    kept = normals[np.sort(first)]
    kept = kept[:: max(1, len(kept) // MAX_NORMALS)]
    return [*kept, *(-kept), *found]
