# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of surfaces that hold an edit up, on both sides of its contacts, for the overlay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.near_assembly import NearAssembly, near_assembly

MAX_POINTS = 32  # contacts; an even selection fades out if there are more
MAX_TRIANGLES = 3000
DENSE = 300  # touching vertices: from here on the region has their triangles alone, which needs no distances
GLOW = 0.08  # least radius of the region around a contact, relative to the smallest object in contact; at most twice
SAMPLE = 2000  # vertices that give the size of an object
REACH = 0.03  # contacts whose sides are further apart are not shown, relative to the same size
SPACING = 0.75  # of the points between contacts, in radii
MAX_STEPS = 8  # radii along a side of the area between contacts
FINENESS = 1.6  # edges longer than this many radii are split, so that the region fades out within large faces
MAX_SPLITS = 9


@dataclass(frozen=True)
class ContactRegion:
    """Faces near contacts, and the closest contact.

    Attributes:
        triangles: (t, 3, 3) positions of corners.
        strengths: (t, 3) for each corner, from 1 at a contact to 0 at the edge of the region.
        closest: (2, 3) the points of the closest contact, one on each side; None without contacts.
    """

    triangles: Floats
    strengths: Floats
    closest: Floats | None = None


NO_REGION = ContactRegion(np.empty((0, 3, 3)), np.empty((0, 3)))


def contact_region(assembly: Assembly, result: stiv.EditResult) -> ContactRegion:
    """The region for the contacts of a result, at its surface; no session is needed."""
    near = near_assembly(assembly, result.surface)
    assembly, surface = near.assembly, near.extended(result.surface)
    events = _of_assembly(near, result.events)
    if len(events) == 0:
        return NO_REGION
    meshes = _meshes_of(assembly, events.vertices)
    size = min(_extent(surface[_range(assembly, mesh)]) for mesh in meshes)
    sides = _sides(events, surface)
    gaps = np.linalg.norm(sides[0] - sides[1], axis=1)
    near = gaps <= REACH * size
    if not near.any():
        return NO_REGION
    closest = sides[:, int(np.argmin(gaps))]
    vertices = np.unique(events.vertices[near])
    marked = np.zeros(len(surface), np.bool_)
    marked[vertices] = True
    if len(vertices) <= DENSE:
        extent = float(np.ptp(sides[:, near].reshape(-1, 3), axis=0).max())
        radius = min(max(GLOW * size, extent / MAX_STEPS), 2.0 * GLOW * size)
        points = _areas(assembly, events.vertices[near], sides[:, near], radius)
        around = _triangles_with(marked | _in_box(assembly, surface, meshes, points, radius), assembly)
        if len(around) <= MAX_TRIANGLES:
            return ContactRegion(*_faded(surface[around], points, radius), closest)
    triangles = _triangles_with(marked, assembly)
    triangles = triangles[:: len(triangles) // MAX_TRIANGLES + 1]
    return ContactRegion(surface[triangles], marked[triangles].astype(np.float64), closest)


def _of_assembly(near: NearAssembly, events: stiv.Events) -> stiv.Events:
    """The events near the surface, with vertices of the near assembly."""
    if not near.obstacles:
        return events
    vertices = near.vertices_of(events.vertices)
    held = (vertices >= 0).all(axis=1)
    return stiv.Events(
        events.kind[held], vertices[held], events.time[held], events.weights[held], events.normal[held],
        events.start_distance[held],
    )  # fmt: skip


def _sides(events: stiv.Events, surface: Floats) -> Floats:
    """The points of all contacts on the first and the second side, (2, k, 3).

    Positive weights of an event give the point on its first side, negative ones that on its second side.
    """
    corners = surface[events.vertices]
    weights = np.stack([np.maximum(events.weights, 0.0), np.maximum(-events.weights, 0.0)])
    return np.asarray(np.einsum("skc,kcx->skx", weights, corners))


def _areas(assembly: Assembly, vertices: Indices, sides: Floats, radius: float) -> Floats:
    """Points, (k, 3), of the contacts, and of the area between those of each pair of meshes."""
    numbers = np.searchsorted(assembly.starts, vertices[:, [0, 3]], side="right")
    found = []
    for pair in np.unique(numbers, axis=0):
        chosen = sides[:, (numbers == pair).all(axis=1)].reshape(-1, 3)
        points = np.unique(_sampled(chosen), axis=0)
        found += [points, _between(points, radius)]
    return np.concatenate(found)


def _sampled(points: Floats) -> Floats:
    chosen = np.unique(np.linspace(0, len(points) - 1, min(len(points), 2 * MAX_POINTS)).astype(int))
    return np.asarray(points[chosen])


def _between(points: Floats, radius: float) -> Floats:
    """Points of a grid inside the convex hull of points that lie in a plane; none for other points."""
    origin = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - origin, full_matrices=False)
    if len(points) < 3 or extents[2] > radius or extents[1] < radius:
        return np.empty((0, 3))
    flat = (points - origin) @ axes[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    steps = np.clip(np.ceil((high - low) / (SPACING * radius)), 1, 2 * MAX_STEPS).astype(int)
    grid = np.stack(np.meshgrid(*(np.linspace(low[k], high[k], steps[k] + 1) for k in range(2))), axis=-1).reshape(
        -1, 2
    )
    hull = _hull(flat)
    edges = np.roll(hull, -1, axis=0) - hull
    offsets = grid[:, None] - hull
    inside = (edges[:, 0] * offsets[..., 1] >= edges[:, 1] * offsets[..., 0]).all(axis=1)
    return np.asarray(origin + grid[inside] @ axes[:2])


def _hull(points: Floats) -> Floats:
    """Corners of the convex hull of points, (k, 2), counterclockwise (Andrew's monotone chain)."""
    ordered = sorted(map(tuple, points.tolist()))

    def chain(remaining: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
        done: list[tuple[float, ...]] = []
        for x, y in remaining:
            while len(done) > 1 and _turn(done[-2], done[-1], (x, y)) <= 0.0:
                done.pop()
            done.append((x, y))
        return done[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _meshes_of(assembly: Assembly, vertices: Indices) -> list[int]:
    """Meshes with any of the vertices."""
    found = np.unique(np.searchsorted(assembly.starts, np.unique(vertices), side="right") - 1)
    return [int(mesh) for mesh in found]


def _range(assembly: Assembly, mesh: int) -> slice:
    return slice(int(assembly.starts[mesh]), int(assembly.starts[mesh + 1]))


def _extent(points: Floats) -> float:
    """About the largest side of the box around points, (n, 3)."""
    return float(np.ptp(points[:: len(points) // SAMPLE + 1], axis=0).max())


def _triangles_with(marked: NDArray[np.bool_], assembly: Assembly) -> Indices:
    """Triangles, (t, 3), with a marked vertex."""
    triangles = assembly.surface.triangles
    a, b, c = (marked[triangles[:, corner]] for corner in range(3))
    found: Indices = triangles[a | b | c]
    return found


def _in_box(assembly: Assembly, surface: Floats, meshes: list[int], points: Floats, radius: float) -> NDArray[np.bool_]:
    """Flags the vertices, (N,), of the meshes in the box around the points."""
    middle, half = (points.max(axis=0) + points.min(axis=0)) / 2, np.ptp(points, axis=0) / 2 + radius
    marked = np.zeros(len(surface), np.bool_)
    for mesh in meshes:
        inside = np.abs(surface[_range(assembly, mesh)] - middle) <= half
        marked[_range(assembly, mesh)] = inside[:, 0] & inside[:, 1] & inside[:, 2]
    return marked


def _faded(corners: Floats, points: Floats, radius: float) -> tuple[Floats, Floats]:
    """Splits large triangles, leaves out those beyond the radius; returns corners and strengths."""
    done = []
    for _ in range(MAX_SPLITS):
        middle = corners.mean(axis=1)
        extents = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
        corners = corners[_distances(middle, points) <= radius + extents]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        small = edges <= FINENESS * radius
        done.append(corners[small])
        corners = corners[~small]
        if not len(corners) or len(corners) > MAX_TRIANGLES:
            break
        corners = _split(corners)
    triangles = np.concatenate([*done, corners])[:MAX_TRIANGLES]
    strengths = 1.0 - np.minimum(_distances(triangles.reshape(-1, 3), points) / radius, 1.0)
    smooth = (strengths * strengths * (3.0 - 2.0 * strengths)).reshape(-1, 3)
    visible = smooth.any(axis=1)
    return triangles[visible], smooth[visible]


def _split(corners: Floats) -> Floats:
    """Each triangle, (t, 3, 3), into four."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    return np.concatenate([np.stack(each, axis=1) for each in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


def _distances(positions: Floats, points: Floats) -> NDArray[np.float64]:
    """Distance from each position, (n, 3), to the closest of the points, (k, 3)."""
    origin = points.mean(axis=0)  # digits are lost far from the world's origin
    p, q = (positions - origin).astype(np.float32), (points - origin).astype(np.float32)
    squares = (p * p).sum(axis=1)[:, None] - 2.0 * (p @ q.T) + (q * q).sum(axis=1)
    return np.asarray(np.sqrt(np.maximum(squares.min(axis=1), 0.0)), np.float64)
