# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the element under the pointer by Blender's rules: reach in pixels, occlusion, order of the elements."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .view import Pixel, Vector, View

if TYPE_CHECKING:
    from ..stiv_blender import SnapMesh, SnapTarget

Numbers = NDArray[np.integer[Any]]
REACH = 30.0  # pixels within which a vertex or an edge is snapped to
SLACK = 0.01  # length by which an element may lie behind the plane of the face under the pointer
MAX_LAYERS = 100  # faces of one object along a view ray
EDGE_ELEMENTS = frozenset({"EDGE", "EDGE_MIDPOINT", "EDGE_PERPENDICULAR"})
SCREEN_ELEMENTS = EDGE_ELEMENTS | {"VERTEX"}  # searched in pixels
GEOMETRY = SCREEN_ELEMENTS | {"FACE", "VOLUME"}


@dataclass(frozen=True)
class Found:
    """A point to snap to: position (3,), and the unit normal of a face or the direction of an edge, (3,)."""

    position: Vector
    direction: Vector
    element: str


@dataclass(frozen=True)
class _Hit:
    """The face under the pointer, in world space; `in_front`: it is turned to the viewer."""

    target: SnapTarget
    position: Vector
    normal: Vector
    face: int
    in_front: bool


@dataclass
class _Nearest:
    """The best candidate so far."""

    distance: float = REACH
    target: SnapTarget | None = None
    position: Vector = field(default_factory=lambda: np.zeros(3))
    direction: Vector = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    edge: int = -1
    vertex: int = -1


@dataclass
class SnapSearch:
    """Searches the elements of targets.

    Attributes:
        targets: what can be snapped to.
        elements: subset of GEOMETRY.
        culling: faces that face away are not snapped to.
        occlusion: faces hide elements behind them; not in an X-ray view.
        as_normals: Blender transforms the directions of faces and edges as normals, as 5.2 does; 4.3 does not.

    """

    targets: Sequence[SnapTarget]
    elements: frozenset[str]
    culling: bool = False
    occlusion: bool = True
    as_normals: bool = False
    _projected: dict[int, _Projected] = field(default_factory=dict)

    def among(self, elements: frozenset[str]) -> SnapSearch:
        """A search for other elements of the same targets."""
        return self if elements == self.elements else replace(self, elements=elements)

    def find(self, pixel: Pixel, view: View, source: Vector) -> Found | None:
        """The point to snap to, None without one. `source` (3,) is the point that perpendiculars start from."""
        hit = self._cast(pixel, view) if self.occlusion or "FACE" in self.elements else None
        found = self._on_screen(pixel, view, source, hit) if self.elements & SCREEN_ELEMENTS else None
        if found is None and hit is not None and "FACE" in self.elements:
            found = Found(hit.position, hit.normal, "FACE")
        return found

    def middle(self, pixel: Pixel, view: View, *, whole: bool) -> Found | None:
        """The middle of the first solid on the view ray. `whole`: between the object's first and last face."""
        origin, direction = view.segment(pixel)
        first: tuple[float, SnapTarget] | None = None
        for target in self.targets:
            hit = next(_hits(target, origin, direction), None)
            if hit is not None and (first is None or (hit.position - origin) @ direction < first[0]):
                first = float((hit.position - origin) @ direction), target
        if first is None:
            return None
        places = [hit.position for hit in _hits(first[1], origin, direction)]
        last = places[-1] if whole else places[min(1, len(places) - 1)]
        return Found((places[0] + last) / 2.0, np.array([0.0, 0.0, 1.0]), "VOLUME")

    def face_under(self, pixel: Pixel, view: View) -> Found | None:
        """The first face on the view ray of a pixel."""
        hit = self._cast(pixel, view)
        return None if hit is None else Found(hit.position, hit.normal, "FACE")

    def nearest(self, start: Vector, point: Vector, *, steps: int, same_object: bool) -> Vector | None:
        """The point of a face nearest to a position, (3,), reached in steps from its start; None without faces."""
        best, distance = None, math.inf
        for target in self.targets:
            inverse = np.linalg.pinv(target.matrix[:3, :3])
            begin, goal = (inverse @ (at - target.matrix[:3, 3]) for at in (start, point))
            tried, linear = begin if same_object else goal, target.matrix[:3, :3]
            nearest = target.closest(tried)
            if nearest is None or (away := float(np.linalg.norm(linear @ (nearest - tried)))) >= distance:
                continue
            place, step = begin, (goal - begin) / steps
            for _ in range(steps):
                reached = target.closest(place + step)
                place = place if reached is None else reached
            best, distance = _world(target, place[None])[0], away
            if not same_object:  # Blender compares the next object with a distance in the space of this one
                distance = float(np.linalg.norm((linear if steps > 1 else np.eye(3)) @ (place - goal)))
        return best

    def _cast(self, pixel: Pixel, view: View) -> _Hit | None:
        origin, direction = view.segment(pixel)
        best, distance = None, math.inf
        for target in self.targets:
            if not target.surface:
                continue
            for hit in _hits(target, origin, direction):
                if self.culling and not hit.in_front:
                    continue
                if (away := float((hit.position - origin) @ direction)) < distance:
                    best, distance = hit, away
                break
        return None if best is None else replace(best, normal=self._direction(best.target, best.normal))

    def _on_screen(self, pixel: Pixel, view: View, source: Vector, hit: _Hit | None) -> Found | None:
        """The vertex or edge nearest to the pointer, in pixels."""
        nearest = _Nearest()
        plane = None
        if self.occlusion and hit is not None:
            self._compare(hit.target, nearest, pixel, view, face=hit.face)
            plane = _occlusion_plane(hit, view.segment(pixel)[1])
        for target in self.targets:
            self._compare(target, nearest, pixel, view, plane=plane)
        if nearest.target is None:
            return None
        if nearest.edge < 0:
            return Found(nearest.position, self._normal_at(nearest.target, nearest.vertex), "VERTEX")
        return self._on_edge(nearest, nearest.target, pixel, view, source)

    def _compare(
        self,
        target: SnapTarget,
        nearest: _Nearest,
        pixel: Pixel,
        view: View,
        *,
        face: int | None = None,
        plane: Vector | None = None,
    ) -> None:
        """Compare the elements of one object, or of one face of it, with the best candidate."""
        if face is None and not _is_near(target, pixel, view, nearest.distance):
            return
        projected = self._projection(target, view)
        with_edges = bool(self.elements & EDGE_ELEMENTS)
        seen = _faces_seen(target, view, pixel) if self.culling and face is None else None
        if "VERTEX" in self.elements:
            mesh = target.mesh
            if face is not None:
                first, last = (0, 0) if with_edges else mesh.starts[face : face + 2]
                vertices: Numbers = mesh.corner_vertices[first:last]
            else:
                vertices = mesh.loose if with_edges else _used(len(mesh.vertices), mesh.corner_vertices, mesh, seen)
            projected.nearest_vertex(vertices, nearest, pixel, plane)
        if with_edges:
            mesh = target.mesh
            if face is not None:
                edges: Numbers = mesh.corner_edges[mesh.starts[face] : mesh.starts[face + 1]]
            else:
                edges = _used(len(mesh.edges), mesh.corner_edges, mesh, seen)
            projected.nearest_edge(edges, nearest, pixel, plane)

    def _on_edge(self, nearest: _Nearest, target: SnapTarget, pixel: Pixel, view: View, source: Vector) -> Found | None:
        """The element of an edge that is snapped to: its middle, its perpendicular, an end, or the point itself."""
        ends = _world(target, target.mesh.vertices[target.mesh.edges[nearest.edge]])
        fraction = _fraction(target, nearest.edge, pixel, view)
        choices = len(self.elements & {"EDGE", "VERTEX", "EDGE_MIDPOINT"})
        share = 1.0 / (2 * choices - 1)
        along_edge = self._direction(target, nearest.direction)
        best, distance = Found(nearest.position, along_edge, "EDGE"), REACH

        def compare(position: Vector, element: str, direction: Vector = along_edge) -> None:
            nonlocal best, distance
            away = _pixels_to(position, pixel, view)
            if away < distance:
                best, distance = Found(position, direction, element), away

        if fraction is not None and self.elements & (SCREEN_ELEMENTS - {"EDGE"}):
            if "EDGE_MIDPOINT" in self.elements:
                share *= choices - 1
                if share < fraction < 1.0 - share:
                    compare(ends.mean(axis=0), "EDGE_MIDPOINT")
            if "EDGE_PERPENDICULAR" in self.elements:
                along = ends[1] - ends[0]
                foot = float((source - ends[0]) @ along / (along @ along))
                if 0.0 <= foot <= 1.0:
                    compare(ends[0] + foot * along, "EDGE_PERPENDICULAR")
            if "VERTEX" in self.elements and (fraction < share or fraction > 1.0 - share):
                end = int(fraction >= 0.5)
                compare(ends[end], "VERTEX", self._normal_at(target, int(target.mesh.edges[nearest.edge][end])))
        return best if best.element in self.elements else None

    def _direction(self, target: SnapTarget, direction: Vector) -> Vector:
        """The world direction that Blender takes; differs from `direction` on targets with unequal scales."""
        if not self.as_normals:
            return direction
        inverse = np.linalg.pinv(target.matrix[:3, :3])
        return _unit(inverse.T @ inverse @ direction)

    def _normal_at(self, target: SnapTarget, vertex: int) -> Vector:
        """The world normal of a vertex; upward for points without a surface."""
        if not target.surface:
            return np.array([0.0, 0.0, 1.0])
        return self._direction(target, _unit(target.matrix[:3, :3] @ target.mesh.vertex_normal(vertex)))

    def _projection(self, target: SnapTarget, view: View) -> _Projected:
        known = self._projected.get(id(target))
        if known is None or known.view is not view:
            known = self._projected[id(target)] = _Projected(target, view)
        return known


class _Projected:
    """The vertices of a target in one view."""

    def __init__(self, target: SnapTarget, view: View):
        self.target, self.view = target, view
        clip = target.mesh.vertices @ (matrix := view.projection @ target.matrix)[:, :3].T + matrix[:, 3]
        self.visible = np.abs(clip[:, 2]) < clip[:, 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            self.pixels = (clip[:, :2] / clip[:, 3:] + 1.0) / 2.0 * np.array(view.size)
        self.before = clip[:, 3] > 0.0

    def nearest_vertex(self, vertices: Numbers, nearest: _Nearest, pixel: Pixel, plane: Vector | None) -> None:
        """Compare vertices, given by their numbers."""
        with np.errstate(invalid="ignore"):
            away = np.hypot(*(self.pixels[vertices] - pixel).T)
            close = np.flatnonzero(self.visible[vertices] & (away < nearest.distance))
        for index in close[np.argsort(away[close], kind="stable")]:
            position = _world(self.target, self.target.mesh.vertices[vertices[index]][None])[0]
            if _is_before(position, plane):
                nearest.distance, nearest.target, nearest.edge = float(away[index]), self.target, -1
                nearest.position, nearest.vertex = position, int(vertices[index])
                return

    def nearest_edge(self, edges: Numbers, nearest: _Nearest, pixel: Pixel, plane: Vector | None) -> None:
        """Compare edges, given by their numbers: each with its point closest to the view ray."""
        edges = edges[self._close(edges, pixel, nearest.distance)]
        if not len(edges):
            return
        mesh = self.target.mesh
        starts, ends = mesh.vertices[mesh.edges[edges, 0]], mesh.vertices[mesh.edges[edges, 1]]
        fractions = np.clip(_fractions(self.target, starts, ends, pixel, self.view), 0.0, 1.0)
        positions = _world(self.target, starts + fractions[:, None] * (ends - starts))
        clip = positions @ self.view.projection[:, :3].T + self.view.projection[:, 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            away = np.hypot(*((clip[:, :2] / clip[:, 3:] + 1.0) / 2.0 * np.array(self.view.size) - pixel).T)
        valid = (np.abs(clip[:, 2]) < clip[:, 3]) & (away < nearest.distance)
        if plane is not None:
            valid &= positions @ plane[:3] + plane[3] > 0.0
        if valid.any():
            index = int(np.where(valid, away, math.inf).argmin())
            nearest.distance, nearest.target, nearest.edge = float(away[index]), self.target, int(edges[index])
            nearest.position = positions[index]
            nearest.direction = _unit(self.target.matrix[:3, :3] @ (ends[index] - starts[index]))

    def _close(self, edges: Numbers, pixel: Pixel, reach: float) -> Vector:
        """Whether the box around each edge in the view is within reach; true for edges partly behind the viewer."""
        first, second = self.target.mesh.edges[edges].T
        with np.errstate(invalid="ignore"):
            low = np.minimum(self.pixels[first], self.pixels[second]) - reach
            high = np.maximum(self.pixels[first], self.pixels[second]) + reach
            within = ((low <= pixel) & (high >= pixel)).all(axis=1)
        return np.asarray(within | ~(self.before[first] & self.before[second]))


def _used(count: int, of_corners: Numbers, mesh: SnapMesh, seen: Vector | None) -> Numbers:
    """Numbers of the vertices or edges: all, or those of the faces seen and those without a face."""
    if seen is None:
        return np.arange(count)
    sizes = np.diff(mesh.starts)
    used = np.ones(count, bool)
    used[of_corners] = False
    used[of_corners[np.repeat(seen, sizes)]] = True
    return np.flatnonzero(used)


def _faces_seen(target: SnapTarget, view: View, pixel: Pixel) -> Vector:
    """Whether each face is turned to the viewer, by its first three corners in a view ray's direction."""
    mesh, direction = target.mesh, view.segment(pixel)[1]
    at = mesh.starts[:-1]
    a, b, c = (_world(target, mesh.vertices[mesh.corner_vertices[at + i]]) for i in range(3))
    return np.asarray(np.cross(b - a, c - a) @ direction < 0.0)


def _hits(target: SnapTarget, origin: Vector, direction: Vector) -> Iterator[_Hit]:
    """All faces of a target along a ray in world space, in order."""
    inverse = np.linalg.pinv(target.matrix[:3, :3])
    start, along = inverse @ (origin - target.matrix[:3, 3]), inverse @ direction
    if not (length := np.linalg.norm(along)) > 0.0:
        return
    along = along / length
    entry = _enters_box(target.low, target.high, start, along)
    if entry is None:
        return
    size = float(np.linalg.norm(target.high - target.low))
    start = start + max(entry - size, 0.0) * along  # near the box, for the precision of Blender's single floats
    for _ in range(MAX_LAYERS):
        found = target.cast(start, along)
        if found is None:
            return
        place, normal, face = found
        yield _Hit(
            target,
            _world(target, place[None])[0],
            _unit(target.matrix[:3, :3] @ normal),
            face,
            bool(normal @ along < 0.0),
        )
        start = place + along * 1e-5 * max(size, 1e-6)


def _enters_box(low: Vector, high: Vector, start: Vector, along: Vector) -> float | None:
    """Length along a ray until it enters a box, None if it misses it."""
    margin = 1e-5 * float(np.linalg.norm(high - low)) + 1e-9
    with np.errstate(divide="ignore", invalid="ignore"):
        bounds = np.stack([low - margin - start, high + margin - start]) / along
    bounds = np.where(np.isnan(bounds), np.array([[-math.inf], [math.inf]]), bounds)
    entry, leave = float(bounds.min(axis=0).max()), float(bounds.max(axis=0).min())
    return entry if entry <= leave and leave >= 0.0 else None


def _is_near(target: SnapTarget, pixel: Pixel, view: View, reach: float) -> bool:
    """Whether the bounds of a target in the view are within reach of a pixel; true if partly behind the viewer."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    points = [view.project(point) for point in _world(target, target.low + corners * (target.high - target.low))]
    if any(point is None for point in points):
        return True
    shown = np.array(points, dtype=float)
    return bool(((shown.min(axis=0) - reach <= pixel) & (shown.max(axis=0) + reach >= pixel)).all())


def _occlusion_plane(hit: _Hit, direction: Vector) -> Vector:
    """(4,) plane of a face, moved back by SLACK: what is behind it is hidden."""
    normal = -hit.normal if hit.normal @ direction > 0.0 else hit.normal
    return np.append(normal, SLACK - normal @ hit.position)


def _is_before(position: Vector, plane: Vector | None) -> bool:
    return plane is None or bool(position @ plane[:3] + plane[3] > 0.0)


def _fraction(target: SnapTarget, edge: int, pixel: Pixel, view: View) -> float | None:
    start, end = target.mesh.vertices[target.mesh.edges[edge]]
    found = float(_fractions(target, start[None], end[None], pixel, view)[0])
    return None if math.isnan(found) else found


def _fractions(target: SnapTarget, starts: Vector, ends: Vector, pixel: Pixel, view: View) -> Vector:
    """Where lines are closest to the view ray, as fractions of their edges, (k,); in the space of the object.

    Edges parallel to the ray give 0.
    """
    origin, direction = view.segment(pixel)
    inverse = np.linalg.pinv(target.matrix[:3, :3])
    origin, direction = inverse @ (origin - target.matrix[:3, 3]), _unit(inverse @ direction)
    normals = np.cross(ends - starts, direction)
    lengths = (normals * normals).sum(axis=1)
    across = (np.cross(starts - origin, direction) * normals).sum(axis=1)
    return np.asarray(np.where(lengths > 0.0, -across / np.where(lengths > 0.0, lengths, 1.0), 0.0))


def _pixels_to(position: Vector, pixel: Pixel, view: View) -> float:
    at = view.project(position)
    return math.inf if at is None else math.hypot(at[0] - pixel[0], at[1] - pixel[1])


def _world(target: SnapTarget, points: Vector) -> Vector:
    return np.asarray(points @ target.matrix[:3, :3].T + target.matrix[:3, 3])


def _unit(vector: Vector) -> Vector:
    length = np.linalg.norm(vector)
    return vector / length if length > 0.0 else vector
