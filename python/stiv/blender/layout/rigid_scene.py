# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies among obstacles: their poses, and the obstacles near one. Without Blender."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

import stiv
from stiv.blender.edit.sessions import open_session
from stiv.blender.layout.element_boxes import ElementBoxes, overlap
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.task import Call, Steps

AUTOMATIC_FRACTION = 1e-4  # of the diagonal of the movers, as in the core
SURPLUS = 1e-4  # of the separation, kept beside it, because Blender stores places in single precision

Elements = list[Indices]
"""Chosen triangles, loose edges and loose vertices of a surface, ascending."""


@dataclass(frozen=True)
class Mover:
    """A rigid body, or several that move as one.

    Attributes:
        name: the object that is written.
        rows: its vertices in the surface of the scene, (n,).
        deformation: from a pose to the positions of these vertices.
        can_turn: is its rotation free?
        free: projection, (3, 3), onto the directions in which its location is free.
    """

    name: str
    rows: Indices
    deformation: stiv.Deformation
    can_turn: bool = True
    free: Floats | None = None

    def along_free(self, vector: Floats) -> Floats:
        """The component of a displacement, (3,), along the free directions."""
        return vector if self.free is None else self.free @ vector


@dataclass(frozen=True)
class Facing:
    """One body of a mover and the obstacles near it that have one minimum distance from it, as a small surface.

    Attributes:
        surface: the rigid body first, then the obstacles as one fixed body.
        rows: their vertices in the surface of the scene, (m,); the first `count` are those of the body.
        positions: of these vertices, (m, 3).
        separation: the minimum distance.
    """

    surface: stiv.Surface
    rows: Indices
    positions: Floats
    count: int
    separation: float

    def moved(self, offset: Floats) -> Floats:
        """The positions, (m, 3), with the body translated by an offset, (3,)."""
        q = self.positions.copy()
        q[: self.count] += offset
        return q


class RigidScene:
    """A surface whose movers have poses, (2, 3): center and rotation vector. Everything else is an obstacle.

    Attributes:
        movers: the bodies that can be posed.
        separation: the minimum distance of all pairs of bodies without one of their own.
        threads: number of threads of a test; 0 uses all cores.
    """

    def __init__(
        self,
        surface: stiv.Surface,
        positions: Floats,
        movers: Sequence[Mover],
        poses: Sequence[Floats],
        separation: float = 0.0,
        pair_separations: Mapping[tuple[int, int], float] | None = None,
        threads: int = 0,
        moving: Sequence[int] | None = None,
    ) -> None:
        """Start at positions, (N, 3), and poses. separation 0: 1e-4 of the diagonal of the `moving` (None: all)."""
        self.movers, self._poses = list(movers), [pose.copy() for pose in poses]
        self._surface, self._positions, self.threads = surface, positions.copy(), threads
        rows = [movers[number].rows for number in (range(len(movers)) if moving is None else moving)]
        self.separation = separation or AUTOMATIC_FRACTION * _diagonal(positions[np.concatenate(rows)])
        self._pair_separations = {(min(pair), max(pair)): h for pair, h in (pair_separations or {}).items()}
        self._ignored = {(min(pair), max(pair)) for pair in surface.ignored.tolist()}
        self._mover_of_vertex = np.full(len(positions), -1, np.int32)
        for number, mover in enumerate(self.movers):
            self._mover_of_vertex[mover.rows] = number
        self._elements = [surface.triangles, surface.loose_edges, _loose_vertices(surface)]
        owners = [self._mover_of_vertex[each[:, 0]] for each in self._elements]
        self._own = [[_rows_where(owner == number) for owner in owners] for number in range(len(self.movers))]
        self._boxes = [
            ElementBoxes(self._positions, each, owner >= 0) for each, owner in zip(self._elements, owners, strict=True)
        ]
        self._element_bodies = [surface.vertex_body[each[:, 0]] for each in self._elements]
        self._mover_of_body = np.full(len(surface.bodies), -1, np.int32)
        self._mover_of_body[surface.vertex_body] = self._mover_of_vertex
        self._body_boxes = np.stack([np.full((len(surface.bodies), 3), sign * np.inf) for sign in (1, -1)])
        np.minimum.at(self._body_boxes[0], surface.vertex_body, self._positions)
        np.maximum.at(self._body_boxes[1], surface.vertex_body, self._positions)
        self.closed: dict[int, bool] = {}  # bodies that are known to be closed or open
        self._bodies = [np.unique(surface.vertex_body[each.rows]).tolist() for each in self.movers]
        self._hidden = np.zeros(len(movers) + 1, np.bool_)  # movers that are left out; the last one: obstacles

    def positions_of(self, mover: int) -> Floats:
        """The vertices of a mover, (n, 3)."""
        return self._positions[self.movers[mover].rows]

    def pose(self, mover: int) -> Floats:
        """Center and rotation vector of a mover, (2, 3)."""
        return self._poses[mover].copy()

    def set_pose(self, mover: int, pose: Floats) -> None:
        """Pose a mover; nothing is tested. Raises InputError if modifiers change its topology there."""
        chosen = self.movers[mover]
        rows = chosen.rows
        try:
            self._positions[rows] = chosen.deformation.surface(pose)
        except stiv.InfeasibleError as error:
            raise stiv.InputError(f"{chosen.name}: its topology changes as it moves; apply its modifiers") from error
        self._poses[mover] = pose.copy()
        for own_elements, boxes in zip(self._own[mover], self._boxes, strict=True):
            boxes.update(self._positions, own_elements)
        for body in self._bodies[mover]:
            own = rows[self._surface.vertex_body[rows] == body]
            self._body_boxes[:, body] = _box(self._positions[own])

    def shift(self, mover: int, vector: Floats) -> None:
        """Translate a mover by a vector, (3,); nothing is tested."""
        pose = self.pose(mover)
        pose[0] += vector
        self.set_pose(mover, pose)

    def leave_out(self, movers: Sequence[int]) -> None:
        """Leave these movers out of all tests, instead of those of the previous call."""
        self._hidden[:] = False
        self._hidden[list(movers)] = True

    def shown_movers(self, mover: int) -> list[int]:
        """The other movers that are not left out."""
        return [each for each in range(len(self.movers)) if each != mover and not self._hidden[each]]

    def with_scaled_movers(self, scale: float) -> RigidScene:
        """A scene in which each mover is scaled about its center, with the same poses as at its start."""
        movers, positions = [], self._positions.copy()
        for number, mover in enumerate(self.movers):
            center = self._poses[number][0]
            positions[mover.rows] = center + scale * (positions[mover.rows] - center)
            movers.append(replace(mover, deformation=stiv.rigid(positions[mover.rows])))
        poses = [stiv.rigid_rest_controls(positions[each.rows]) for each in movers]
        distances = dict(self._pair_separations)
        return RigidScene(self._surface, positions, movers, poses, self.separation, distances, self.threads)

    def with_copies(self, mover: int, factors: Floats) -> RigidScene:
        """A scene with copies of a mover behind all movers, scaled by `factors`, (k,), about its center."""
        own = self.movers[mover].rows
        surface, bodies = self._surface, self._bodies[mover]
        copies, parts = len(factors), [self._positions]
        place = np.full(len(self._positions), -1, np.int32)
        place[own] = np.arange(len(own), dtype=np.int32)
        elements = [each[place[each[:, 0]] >= 0] for each in self._elements[:2]]
        triangles, edges = [surface.triangles], [surface.loose_edges]
        numbers, body = {number: k for k, number in enumerate(bodies)}, [surface.vertex_body]
        movers, poses = list(self.movers), list(self._poses)
        rest = self.positions_of(mover)
        center = stiv.rigid_rest_controls(rest)[0]
        for copy, factor in enumerate(factors):
            first = np.int32(len(self._positions) + copy * len(own))
            scaled = center + factor * (rest - center)
            parts.append(scaled)
            triangles.append(place[elements[0]] + first)
            edges.append(place[elements[1]] + first)
            offset = len(surface.bodies) + copy * len(bodies)
            body.append(np.array([offset + numbers[each] for each in surface.vertex_body[own].tolist()], np.int32))
            rows = np.arange(first, first + len(own), dtype=np.int32)
            movers.append(replace(self.movers[mover], rows=rows, deformation=stiv.rigid(scaled)))
            poses.append(stiv.rigid_rest_controls(scaled))
        names = [surface.bodies[number] for _ in range(copies) for number in bodies]
        larger = stiv.Surface(
            np.concatenate(triangles),
            len(self._positions) + copies * len(own),
            np.concatenate(edges),
            np.concatenate(body),
            [*surface.bodies, *names],
            self._copied_pairs(sorted(self._ignored), bodies, copies),
        )
        distances = {
            pair: h
            for (a, b), h in self._pair_separations.items()
            for pair in [(a, b), *self._copied_pairs([(a, b)], bodies, copies)]
        }
        return RigidScene(larger, np.concatenate(parts), movers, poses, self.separation, distances, self.threads)

    def _copied_pairs(
        self, pairs: Sequence[tuple[int, int]], bodies: Sequence[int], copies: int
    ) -> list[tuple[int, int]]:
        """Pairs of bodies, with those of copies of some bodies; pairs within these bodies stay within a copy."""
        count, found = len(self._surface.bodies), list(pairs)
        for copy in range(copies):
            number = {body: count + copy * len(bodies) + k for k, body in enumerate(bodies)}
            found += [(number.get(a, a), number.get(b, b)) for a, b in pairs if a in number or b in number]
        return found

    def components(self, mover: int) -> Floats:
        """A vertex, (3,), of each connected component of a mover, (k, 3)."""
        own = self._mover_of_vertex[self._surface.triangles[:, 0]] == mover
        label = np.arange(len(self._positions))
        triangles = self._surface.triangles[own]
        while len(triangles):
            least = label[triangles].min(axis=1)
            if (label[triangles] == least[:, None]).all():
                break
            for corner in range(3):
                np.minimum.at(label, triangles[:, corner], least)
            label = label[label]
        return self._positions[np.unique(label[self.movers[mover].rows])]

    def box(self, mover: int) -> Floats:
        """Lowest and highest corner of a mover, (2, 3)."""
        return _box(self.positions_of(mover))

    def size(self, mover: int) -> float:
        """Diagonal of the box of a mover."""
        return _diagonal(self.positions_of(mover))

    def extent(self) -> Floats:
        """Lowest and highest corner of everything, (2, 3)."""
        return self._extent_of(np.ones(len(self._surface.bodies), np.bool_))

    def _extent_of(self, bodies: Flags) -> Floats:
        low, high = self._body_boxes[:, bodies]
        return np.stack([low.min(axis=0), high.max(axis=0)])

    @property
    def largest_separation(self) -> float:
        """The largest minimum distance of any pair."""
        return max([self.separation, *self._pair_separations.values()])

    def extent_among(self, mover: int, among: Flags | None) -> Floats:
        """Lowest and highest corner of the obstacles of a mover, (2, 3); of itself without any. among: see `facing`."""
        bodies = self._bodies_near(mover, None, among)
        return self._extent_of(bodies) if bodies.any() else self.box(mover)

    def bodies_around(self, mover: int, among: Flags | None = None) -> Iterator[tuple[int, Indices]]:
        """Each obstacle whose box touches that of a mover, with its triangles, (f, 3). among: see `facing`."""
        for number in np.flatnonzero(self._bodies_near(mover, self.box(mover), among)):
            yield int(number), self._surface.triangles[self._element_bodies[0] == number]

    def name_at(self, row: int) -> str:
        """The name of the body of a vertex."""
        return self._surface.bodies[int(self._surface.vertex_body[row])].name

    def corners(self, triangles: Indices) -> Floats:
        """Positions of the corners of triangles, (f, 3, 3)."""
        return self._positions[triangles]

    def session(self, mover: int, box: Floats) -> Steps[stiv.EditSession]:
        """Steps that make a session that poses one mover among the obstacles in a box, (2, 3).

        A response aims for twice the separation of its session, which is therefore half the minimum distance.
        """
        elements = _united(self._own[mover], self._near(mover, box, None))
        rows = self._rows(mover, elements)
        bodies = [
            stiv.Body(body.name, "rigid" if number in self._bodies[mover] else "fixed")
            for number, body in enumerate(self._surface.bodies)
        ]
        surface = self._part(elements, rows, self._surface.vertex_body[rows], bodies, sorted(self._ignored))
        own = np.arange(len(self.movers[mover].rows), dtype=np.int32)
        options = stiv.EditOptions(
            separation=self.separation / 2,
            pair_separations={(a, b): h / 2 for (a, b), h in self._pair_separations.items()},
            single_precision=False,
            threads=self.threads,
        )
        deformation = stiv.concatenate([(self.movers[mover].deformation, own)], self._positions[rows])
        given = surface, deformation, self._poses[mover], options
        session: stiv.EditSession = yield Call(open_session, stiv.EditSession.start, *given)
        return session

    def facing(
        self, mover: int, offsets: Floats | None, among: Flags | None = None, margin: float = 1.0
    ) -> Iterator[Facing]:
        """Each body of a mover, and the obstacles near it between two offsets, (2, 3), that have one minimum distance.

        Elements that stay far from each other are left out. offsets None: everywhere, with all elements. among:
        flags of the movers that are obstacles here, (k + 1,), the last for everything else; None: all are. margin: in
        minimum distances.
        """
        reach = margin * self.largest_separation
        swept = None if offsets is None else np.stack([offsets.min(axis=0) - reach, offsets.max(axis=0) + reach])
        near = self._near(mover, None if swept is None else self.box(mover) + swept, among)
        if not any(map(len, near)):
            return
        mine = self._own[mover] if swept is None else self._own_near(mover, near, swept)
        for body in self._bodies[mover]:
            own = [rows[bodies[rows] == body] for rows, bodies in zip(mine, self._element_bodies, strict=True)]
            distances = np.array([self._separation_of(body, other) for other in range(len(self._surface.bodies))])
            for h in np.unique(distances[distances > 0]):
                others = [
                    rows[distances[bodies[rows]] == h] for rows, bodies in zip(near, self._element_bodies, strict=True)
                ]
                if any(map(len, others)) and any(map(len, own)):
                    yield self._face(own, others, float(h))

    def _own_near(self, mover: int, near: Elements, swept: Floats) -> Elements:
        """The elements of a mover that may approach other ones between offsets, (2, 3)."""
        lows = [boxes.low[rows] for rows, boxes in zip(near, self._boxes, strict=True)]
        highs = [boxes.high[rows] for rows, boxes in zip(near, self._boxes, strict=True)]
        lowest, highest = np.concatenate(lows).min(axis=0), np.concatenate(highs).max(axis=0)
        around = np.stack([lowest - swept[1], highest - swept[0]])
        return [boxes.among(own, around) for own, boxes in zip(self._own[mover], self._boxes, strict=True)]

    def _face(self, own: Elements, others: Elements, separation: float) -> Facing:
        first, second = self._used(own), self._used(others)
        rows = np.concatenate([first, second])
        body = np.repeat(np.array([0, 1], np.int32), [len(first), len(second)])
        bodies = [stiv.Body("mover", "rigid"), stiv.Body("obstacles", "fixed")]
        surface = self._part(_united(own, others), rows, body, bodies, ())
        return Facing(surface, rows, self._positions[rows], len(first), separation)

    def _used(self, elements: Elements) -> Indices:
        """The vertices of chosen triangles, loose edges and loose vertices."""
        return np.unique(
            np.concatenate([all_[rows].ravel() for all_, rows in zip(self._elements, elements, strict=True)])
        )

    def _rows(self, mover: int, elements: Elements) -> Indices:
        """All vertices of a mover, then those of other chosen elements."""
        own = self.movers[mover].rows
        return np.concatenate([own, np.setdiff1d(self._used(elements), own)])

    def _part(
        self,
        elements: Elements,
        rows: Indices,
        body: Indices,
        bodies: Sequence[stiv.Body],
        ignored: Sequence[tuple[int, int]],
    ) -> stiv.Surface:
        number = np.zeros(len(self._positions), np.int32)
        number[rows] = np.arange(len(rows), dtype=np.int32)
        triangles, edges = (number[self._elements[k][elements[k]]] for k in (0, 1))
        return stiv.Surface(triangles, len(rows), edges, body, bodies, ignored)

    def _near(self, mover: int, box: Floats | None, among: Flags | None) -> Elements:
        """The elements of other bodies near a box, (2, 3); None: everywhere."""
        bodies, found = self._bodies_near(mover, box, among), []
        for body, boxes in zip(self._element_bodies, self._boxes, strict=True):
            if box is None or not bodies.any():
                found.append(_rows_where(bodies[body]) if box is None else np.empty(0, np.int32))
                continue
            rows = boxes.touching(box)
            found.append(rows[bodies[body[rows]]])
        return found

    def _bodies_near(self, mover: int, box: Floats | None, among: Flags | None) -> Flags:
        """Flags of the other bodies whose box touches a box, (2, 3); None: of all of them."""
        tested = ~self._hidden if among is None else among & ~self._hidden
        tested[mover] = False
        bodies: Flags = tested[self._mover_of_body]
        if box is not None:
            bodies &= overlap(self._body_boxes[0], self._body_boxes[1], box)
        return bodies

    def _separation_of(self, body: int, other: int) -> float:
        """The minimum distance of two bodies; 0 for bodies that are not tested."""
        pair = (min(body, other), max(body, other))
        return 0.0 if pair in self._ignored else self._pair_separations.get(pair, self.separation)


def _loose_vertices(surface: stiv.Surface) -> Indices:
    """Vertices without a triangle or a loose edge, (k, 1)."""
    used = np.zeros(surface.vertex_count, np.bool_)
    used[surface.triangles] = True
    used[surface.loose_edges] = True
    return np.flatnonzero(~used).astype(np.int32)[:, None]


def _rows_where(flags: Flags) -> Indices:
    return np.flatnonzero(flags).astype(np.int32)


def _united(first: Elements, second: Elements) -> Elements:
    """All elements of two choices that have none in common."""
    return [np.sort(np.concatenate(pair)) for pair in zip(first, second, strict=True)]


def _box(points: Floats) -> Floats:
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _diagonal(points: Floats) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
