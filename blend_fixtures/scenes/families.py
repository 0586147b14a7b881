# SPDX-License-Identifier: GPL-3.0-or-later
"""Seven families of edits for measuring the response, each with surface, deformation, start and goal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

import stiv

from .cages import bent_sheet
from .primitives import box, grid, icosphere, triangulated
from .shape import Shape, joined
from .sweeps import trefoil, tube
from .walls import wavy_wall

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Edit:
    """One edit: initial controls (m, 3), and their goal (m, 3)."""

    name: str
    surface: stiv.Surface
    deformation: stiv.Deformation
    controls: Array
    goal: Array
    options: dict[str, object] = field(default_factory=dict)  #: of stiv.EditOptions, unless default


def _surface(shapes: Sequence[Shape], mobilities: Sequence[str]) -> stiv.Surface:
    """Concatenated shapes, each a separate body."""
    whole = joined(shapes)
    bodies = [stiv.Body(f"{mobility} {number}", mobility) for number, mobility in enumerate(mobilities)]
    owner = np.repeat(np.arange(len(shapes)), [len(shape.vertices) for shape in shapes])
    return stiv.Surface(whole.triangles(), vertex_count=len(whole.vertices), vertex_body=owner, bodies=bodies)


def _against_obstacle(
    name: str, mover: Shape, mobility: str, obstacle: Shape, deformation: stiv.Deformation, controls: Array, goal: Array
) -> Edit:
    """A mover under `deformation` and a fixed obstacle."""
    start = joined([mover, obstacle]).vertices
    whole = stiv.concatenate([(deformation, np.arange(len(mover.vertices)))], start)
    return Edit(name, _surface([mover, obstacle], [mobility, "fixed"]), whole, controls, goal)


def _free_vertices(name: str, shapes: Sequence[Shape], offsets: Sequence[Sequence[float]]) -> Edit:
    """Every vertex is a control; the goal translates each shape."""
    start = joined(shapes).vertices
    motion = np.concatenate([np.tile(o, (len(s.vertices), 1)) for s, o in zip(shapes, offsets, strict=True)])
    surface = _surface(shapes, ["deformable"] * len(shapes))
    return Edit(name, surface, stiv.identity(len(start)), start, start + motion)


def spheres(depth: float, levels: int = 3) -> Edit:
    """A sphere moved by `depth` into another deformable one 0.2 away, and through it from 4.3 on."""
    ball = icosphere(levels)
    other = ball.turned((0.4, 1.1, 2.3)).moved((2.2, 0.1, 0.07))
    return _free_vertices(f"spheres {depth:g}", [ball, other], [(depth, 0, 0), (0, 0, 0)])


def sheets(depth: float, cells: int = 15) -> Edit:
    """A small rippled sheet moved down by `depth` through a larger one 0.2 below it."""
    lower = triangulated(grid(cells, cells))
    upper = lower.scaled((0.6, 0.6, 1)).turned((0, 0, 0.2)).moved((0.03, 0.02, 0.2))
    ripple = np.zeros_like(upper.vertices)
    ripple[:, 2] = 0.05 * np.sin(5 * upper.vertices[:, 0])
    return _free_vertices(f"sheets {depth:g}", [lower, upper.moved(ripple)], [(0, 0, 0), (0, 0, -depth)])


def fold(angle: float = 1.35 * np.pi) -> Edit:
    """A sheet bent by 0.8 pi, to be bent by `angle`: beyond about pi it intersects itself."""
    start, goal = bent_sheet(0.8 * np.pi), bent_sheet(angle)
    surface = _surface([start], ["deformable"])
    return Edit(
        f"fold {angle / np.pi:g} pi", surface, stiv.identity(len(start.vertices)), start.vertices, goal.vertices
    )


def _catmull_clark(shape: Shape) -> tuple[Array, Shape]:
    """One subdivision of a closed quad mesh: weights (n', n) and the finer mesh. [Catmull and Clark 1978]"""
    quads = np.array(shape.faces)
    count = len(shape.vertices)
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, edge_of_side = np.unique(sides, axis=0, return_inverse=True)
    edge_of_side = edge_of_side.reshape(quads.shape)
    corners = np.eye(count)
    faces = corners[quads].mean(axis=1)
    middles = corners[edges].mean(axis=1)
    around = np.zeros((len(edges), count))  # the two faces of each edge
    np.add.at(around, edge_of_side.ravel(), np.repeat(faces, 4, axis=0))
    of_faces, of_edges = np.zeros((count, count)), np.zeros((count, count))
    np.add.at(of_faces, quads.ravel(), np.repeat(faces, 4, axis=0))
    np.add.at(of_edges, edges.ravel(), np.repeat(middles, 2, axis=0))
    valence = np.bincount(edges.ravel())[:, None]
    vertices = (of_faces / valence + 2 * of_edges / valence + (valence - 3) * corners) / valence
    weights = np.concatenate([vertices, middles / 2 + around / 4, faces])
    edge, face = count + edge_of_side, count + len(edges) + np.arange(len(quads))
    finer = [
        (q[k], e[k], f, e[k - 1])
        for q, e, f in zip(quads.tolist(), edge.tolist(), face.tolist(), strict=True)
        for k in range(4)
    ]
    return weights, Shape(weights @ shape.vertices, tuple(finer))


def subdivision(depth: float, levels: int = 3) -> Edit:
    """A subdivided box with a cage of 26 points, moved down by `depth` into a wavy sheet."""
    cage = box(2).moved((0, 0, 1.25))
    weights, fine = np.eye(len(cage.vertices)), cage
    for _ in range(levels):
        step, fine = _catmull_clark(fine)
        weights = step @ weights
    goal = cage.vertices + (0.1, 0, -depth)
    wall = triangulated(wavy_wall()).moved((0, 0, -0.02))
    name = f"subdivision {depth:g}"
    return _against_obstacle(name, fine, "deformable", wall, stiv.linear(weights), cage.vertices, goal)


def _loop_ball_on_wall(name: str, depth: float, handles: NDArray[np.int64] | None) -> Edit:
    """A Loop subdivision ball of 42 points, moved down by `depth` into a wavy sheet, optionally by `handles`."""
    cage = icosphere(1).moved((0, 0, 1.1))
    deformation, triangles = stiv.loop(stiv.Cage.of_faces(cage.faces), 2)
    fine = Shape(deformation.surface(cage.vertices), tuple(map(tuple, triangles.tolist())))
    controls = cage.vertices if handles is None else cage.vertices[handles]
    if handles is not None:
        deformation = stiv.compose(deformation, stiv.laplacian(cage.vertices, cage.faces, handles))
    wall = triangulated(wavy_wall()).moved((0, 0, -0.02))
    goal = controls + (0.1, 0, -depth)
    return _against_obstacle(f"{name} {depth:g}", fine, "deformable", wall, deformation, controls, goal)


def loop(depth: float) -> Edit:
    """A Loop subdivision surface with its cage; not one of the fourteen."""
    return _loop_ball_on_wall("loop", depth, None)


def loop_by_handles(depth: float) -> Edit:
    """A Loop subdivision surface whose cage is edited by Laplacian handles; not one of the fourteen."""
    return _loop_ball_on_wall("loop by handles", depth, np.arange(0, 42, 3))


def _bspline_weights(points: Array, low: Array, high: Array, counts: tuple[int, int, int]) -> tuple[Array, Array]:
    """Tri-cubic uniform B-spline weights (n, m) over a box, and the rest positions (m, 3) that reproduce space."""
    spans = np.array(counts) - 3
    place = (points - low) / (high - low) * spans
    cell = np.minimum(place.astype(int), spans - 1)
    u = place - cell
    cubic = np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3]) / 6
    weights = np.zeros((len(points), *counts))
    rows = np.arange(len(points))
    for i, j, k in np.ndindex(4, 4, 4):
        weights[rows, cell[:, 0] + i, cell[:, 1] + j, cell[:, 2] + k] = cubic[i, :, 0] * cubic[j, :, 1] * cubic[k, :, 2]
    index = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 3)
    return weights.reshape(len(points), -1), low + (index - 1) / spans * (high - low)


def _bunch(count: int) -> Shape:
    """Shoots on a circle of three radii that lean outward."""
    shoots = []
    for number in range(count):
        angle = 2 * np.pi * number / count
        height = np.linspace(0, 2, 24)
        out = (0.12 + 0.11 * (number % 3)) * (1 + 0.35 * height)
        path = np.stack([out * np.cos(angle), out * np.sin(angle), height], axis=1)
        shoots.append(tube(path, np.full(24, 0.03), 6))
    return joined(shoots)


def _open_vase(rings: int = 26, sides: int = 28) -> Shape:
    """A surface of revolution without thickness, with a neck narrower than the bunch."""
    height = np.linspace(-1.2, 1.2, rings)
    radius = 0.42 + 0.18 * np.cos(1.3 * height + 2.2) ** 2
    angle = 2 * np.pi * np.arange(sides) / sides
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    vertices = (radius[:, None, None] * circle + height[:, None, None] * [0, 0, 1]).reshape(-1, 3)
    faces = [
        (i * sides + j, i * sides + (j + 1) % sides, (i + 1) * sides + (j + 1) % sides, (i + 1) * sides + j)
        for i in range(rings - 1)
        for j in range(sides)
    ]
    return Shape(vertices, tuple(faces))


def vase(depth: float, count: int = 12) -> Edit:
    """Shoots in a tri-cubic lattice, lowered by `depth` into a vase that is too narrow for them."""
    bunch = _bunch(count).moved((0, 0, 1.28))
    low, high = bunch.vertices.min(axis=0) - 0.01, bunch.vertices.max(axis=0) + 0.01
    weights, lattice = _bspline_weights(bunch.vertices, low, high, (6, 6, 8))
    goal = lattice + (0, 0, -depth)
    return _against_obstacle(f"vase {depth:g}", bunch, "deformable", _open_vase(), stiv.linear(weights), lattice, goal)


def rigid(depth: float, size: float = 1.0) -> Edit:
    """A tilted rigid ellipsoid moved down by `depth` and sideways, against a flat wall 0.6 below."""
    body = icosphere(2).scaled((0.8, 0.4, 0.25)).turned((0, 0.4, 0.3)).scaled(size).moved((0, 0, size))
    wall = triangulated(grid(19, 19, 4 * size, 4 * size))
    start = np.stack([body.vertices.mean(axis=0), np.zeros(3)])
    goal = start + np.array([[0.3, 0, -depth], [0, 0, 0]]) * size
    return _against_obstacle(f"rigid {depth:g}", body, "rigid", wall, stiv.rigid(body.vertices), start, goal)


def _laplacian_map(shape: Shape, handles: NDArray[np.int64]) -> tuple[Array, Array]:
    """Weights (n, m) of soft handles and offset (n, 3) of Laplacian editing, by a dense solve. [App. B, Eq. 4]"""
    count = len(shape.vertices)
    triangles = shape.triangles()
    adjacent = np.zeros((count, count))
    for k in range(3):
        adjacent[triangles[:, k], triangles[:, k - 1]] = adjacent[triangles[:, k - 1], triangles[:, k]] = 1
    laplacian = np.eye(count) - adjacent / adjacent.sum(axis=1)[:, None]
    select = np.zeros((len(handles), count))
    select[np.arange(len(handles)), handles] = 1
    normal = laplacian.T @ laplacian + select.T @ select
    solved = np.linalg.solve(normal, np.hstack([select.T, laplacian.T @ (laplacian @ shape.vertices)]))
    return solved[:, : len(handles)], solved[:, len(handles) :]


def knot(lift: float, rings: int = 150, sides: int = 10) -> Edit:
    """A knotted tube under Laplacian editing: its foot is fixed, and its top is lifted by `lift`."""
    shape = trefoil(rings, sides)
    y = shape.vertices[:, 1]
    foot, top = np.flatnonzero(y < np.quantile(y, 0.12)), np.flatnonzero(y > np.quantile(y, 0.9))
    handles = np.concatenate([foot, top])
    weights, offset = _laplacian_map(shape, handles)
    goal = shape.vertices[handles].copy()
    goal[len(foot) :, 1] += lift
    free = np.concatenate([np.zeros(len(foot)), np.ones(len(top))])
    surface = _surface([Shape(shape.vertices, shape.faces)], ["deformable"])
    deformation = stiv.linear(weights, offset)
    return Edit(f"knot {lift:g}", surface, deformation, shape.vertices[handles], goal, {"weights": free})


def bulge(depth: float, cells: int = 16, rigid: bool = False) -> Edit:
    """A sheet moved by handles with a fixed boundary: its centre moves down by `depth` into a wavy sheet.

    Handles next to the centre are pinned. Laplacian or as-rigid-as-possible editing. Not one of the fourteen.
    """
    sheet = triangulated(grid(cells, cells)).moved((0, 0, 0.5))
    x, y = sheet.vertices[:, 0] / np.ptp(sheet.vertices[:, 0]), sheet.vertices[:, 1] / np.ptp(sheet.vertices[:, 1])
    rim = np.flatnonzero(np.maximum(abs(x), abs(y)) > 0.49)
    patch = np.flatnonzero(np.hypot(x, y) < 0.15)
    pinned = np.flatnonzero((x > 0.3) & (x < 0.4) & (abs(y) < 0.2))
    handles = np.concatenate([patch, pinned])
    make = stiv.arap if rigid else stiv.laplacian
    deformation = make(sheet.vertices, sheet.triangles(), handles, fixed=rim, pull=None)
    goal = sheet.vertices[handles].copy()
    goal[: len(patch), 2] -= depth
    free = np.repeat([1.0, 0.0], [len(patch), len(pinned)])
    wall = triangulated(wavy_wall()).moved((0, 0, -0.02))
    edit = _against_obstacle(
        f"{'rigid ' if rigid else ''}bulge {depth:g}",
        sheet,
        "deformable",
        wall,
        deformation,
        sheet.vertices[handles].copy(),
        goal,
    )
    return replace(edit, options={"weights": free})


def all_edits() -> list[Edit]:
    """Fourteen edits of the seven families: shallow, deep, and fully through the obstacle."""
    return [
        *(spheres(depth) for depth in (0.5, 1.5, 4.6)),
        *(sheets(depth) for depth in (0.5, 1.0)),
        fold(),
        *(subdivision(depth) for depth in (0.6, 1.2)),
        *(vase(depth) for depth in (1.5, 2.2)),
        *(rigid(depth) for depth in (0.7, 1.6)),
        *(knot(lift) for lift in (0.5, 1.0)),
    ]
