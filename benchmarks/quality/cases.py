# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of real models: cages, lattices, handles, shells, rigid bodies, gaps and goals deep inside obstacles.

The models are a rabbit and an ogre of about 1,500 vertices, decimated with libigl.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from benchmarks.sessions.models import largest_part
from blend_fixtures.scenes.families import Edit
from blend_fixtures.scenes.primitives import box, grid, icosphere, torus, triangulated
from blend_fixtures.scenes.shape import Shape, joined
from stiv import InputError
from stiv.mesh_files import read_mesh

Array = NDArray[np.float64]
Indices = NDArray[np.integer]
FILES = {"bunny": "stanford-bunny.obj", "ogre": "ogre.obj"}
TRIANGLES = 3000  #: of a model after decimation


@dataclass(frozen=True)
class Models:
    """The decimated models of a folder: upright along z, centred, with a diagonal of 1."""

    folder: Path

    def __call__(self, name: str) -> Shape:
        """The model `bunny` or `ogre`. Raises InputError without its file, or without libigl."""
        return _decimated(self.folder / FILES[name])


@cache
def _decimated(path: Path) -> Shape:
    if not path.is_file():
        raise InputError(f"{path}: there is no such file; bench quality needs {', '.join(FILES.values())}")
    try:
        igl = importlib.import_module("igl")
    except ModuleNotFoundError as error:
        raise InputError("bench quality needs libigl: pip install -r tools/requirements/bench.txt") from error
    mesh = read_mesh(path)
    given = np.asarray(mesh.vertices, float)
    whole = stiv.weld(stiv.Surface(mesh.triangles, len(given)), given)
    vertices, triangles = largest_part(whole.positions, whole.surface.triangles)
    vertices, triangles = igl.decimate(vertices, triangles.astype(np.int64), TRIANGLES)[:2]
    upright = vertices[:, [0, 2, 1]] * (1.0, -1.0, 1.0)
    low, high = upright.min(axis=0), upright.max(axis=0)
    unit = (upright - (low + high) / 2) / np.linalg.norm(high - low)
    return Shape(unit.astype(np.float32).astype(float), tuple(map(tuple, triangles.tolist())))


def _edit(
    name: str, mover: Shape, obstacles: Sequence[Shape], deformation: stiv.Deformation, controls: Array, goal: Array
) -> Edit:
    start = joined([mover, *obstacles])
    mobility = "rigid" if len(controls) == 2 else "deformable"
    bodies = [stiv.Body("Mover", mobility), *(stiv.Body(f"Obstacle {k}", "fixed") for k in range(len(obstacles)))]
    owner = np.repeat(np.arange(len(bodies)), [len(shape.vertices) for shape in (mover, *obstacles)])
    surface = stiv.Surface(start.triangles(), vertex_count=len(owner), vertex_body=owner, bodies=bodies)
    moves = np.arange(len(mover.vertices))
    whole = stiv.concatenate([(deformation, moves)], start.vertices)
    return Edit(name, surface, whole, controls, goal)


def by_vertices(name: str, mover: Shape, obstacles: Sequence[Shape], goal: Array) -> Edit:
    """Every vertex of the mover is a control."""
    return _edit(name, mover, obstacles, stiv.identity(len(goal)), mover.vertices, goal)


def by_lattice(
    name: str, mover: Shape, obstacles: Sequence[Shape], resolution: Sequence[int], move: Callable[[Array], Array]
) -> Edit:
    """The mover in a lattice, whose points all move."""
    low, high = mover.vertices.min(axis=0) - 0.02, mover.vertices.max(axis=0) + 0.02
    frame = np.diag([*(high - low) / (np.array(resolution) - 1), 1.0])
    frame[:3, 3] = (low + high) / 2
    points = stiv.lattice_rest_points(resolution) @ frame[:3, :3].T + frame[:3, 3]
    return _edit(name, mover, obstacles, stiv.lattice(mover.vertices, resolution, frame=frame), points, move(points))


def by_cage(name: str, cage: Shape, levels: int, obstacles: Sequence[Shape], move: Callable[[Array], Array]) -> Edit:
    """A Loop subdivision surface, moved by its cage."""
    deformation, triangles = stiv.loop(stiv.Cage.of_faces(cage.faces), levels)
    mover = Shape(deformation.surface(cage.vertices), tuple(map(tuple, triangles.tolist())))
    return _edit(name, mover, obstacles, deformation, cage.vertices, move(cage.vertices))


def by_handles(
    name: str,
    mover: Shape,
    obstacles: Sequence[Shape],
    handles: Indices,
    fixed: Indices,
    move: Callable[[Array], Array],
) -> Edit:
    """Laplacian editing by some vertices."""
    deformation = stiv.laplacian(mover.vertices, mover.triangles(), handles, fixed=fixed)
    points = mover.vertices[handles]
    return _edit(name, mover, obstacles, deformation, points, move(points))


def rigidly(
    name: str, mover: Shape, obstacles: Sequence[Shape], motion: Sequence[float], turn: Sequence[float]
) -> Edit:
    """A rigid body; the goal adds `motion` and `turn` to its controls."""
    rest = stiv.rigid_rest_controls(mover.vertices)
    return _edit(name, mover, obstacles, stiv.rigid(mover.vertices), rest, rest + np.array([motion, turn], float))


def _moved(*offset: float) -> Callable[[Array], Array]:
    return lambda points: points + np.array(offset)


def _slab(at: Sequence[float], size: tuple[float, float, float], cuts: int = 8) -> Shape:
    return triangulated(box(cuts, size)).moved(at)


def _gap(width: float, at: float) -> list[Shape]:
    """Two blocks at x = `at` with a gap of this width along y between them."""
    return [_slab((at, side * (width / 2 + 0.5), 0), (0.2, 1.0, 1.6)) for side in (-1, 1)]


def _bars(count: int, at: float) -> list[Shape]:
    """Upright bars of a grating at x = `at`."""
    return [_slab((at, y, 0), (0.06, 0.06, 1.6), 3) for y in np.linspace(-0.45, 0.45, count)]


def _shell(size: float, cells: int) -> Shape:
    return triangulated(grid(cells, cells, size, size))


def cases(folder: Path) -> dict[str, Callable[[], Edit]]:
    """The edits by name, each built when it is called."""
    model = Models(folder)
    ball = triangulated(icosphere(3, 0.3))

    def nearest(shape: Shape, *places: Sequence[float]) -> Indices:
        return np.unique([int(np.linalg.norm(shape.vertices - p, axis=1).argmin()) for p in places])

    def bunny_handles() -> Edit:
        bunny = model("bunny")
        low = np.flatnonzero(bunny.vertices[:, 2] < bunny.vertices[:, 2].min() + 0.05)
        top = np.flatnonzero(bunny.vertices[:, 2] > bunny.vertices[:, 2].max() - 0.12)[::4]
        return by_handles("bunny handles", bunny, [ball.moved((0.45, 0, 0.35))], top, low, _moved(0.35, 0, 0))

    def ogre_arm() -> Edit:
        ogre = model("ogre")
        hand = nearest(ogre, *((ogre.vertices[:, 0].max(), y, z) for y in (-0.05, 0.05) for z in (-0.1, 0.0, 0.1, 0.2)))
        fixed = np.flatnonzero(abs(ogre.vertices[:, 0]) < 0.05)
        wall = _slab((0.42, 0, -0.3), (0.6, 1.0, 0.1))
        return by_handles("ogre arm", ogre, [wall], hand, fixed, _moved(-0.1, 0.0, -0.5))

    def grown() -> Edit:
        bunny = model("bunny")
        cube = Shape(1.06 * _slab((0, 0, 0), (1, 1, 1)).vertices, _slab((0, 0, 0), (1, 1, 1)).faces)
        inside = Shape(cube.vertices, tuple(tuple(reversed(f)) for f in cube.faces))
        return by_vertices("bunny grown", bunny, [inside], 2.2 * bunny.vertices)

    def bent() -> Edit:
        ogre = model("ogre")

        def close(points: Array) -> Array:
            angle = 2.4 * points[:, 0]
            radius = 0.35 + points[:, 1]
            return np.stack([radius * np.sin(angle), radius * np.cos(angle) - 0.35, points[:, 2]], axis=1)

        return by_lattice("ogre bent", ogre, [_slab((0.1, -0.35, 0), (0.3, 0.3, 1.0))], (7, 4, 5), close)

    every: dict[str, Callable[[], Edit]] = {
        "bunny lattice deep": lambda: by_lattice(
            "bunny lattice deep", model("bunny"), [_slab((0.6, 0, 0), (0.1, 2.0, 2.0))], (5, 5, 5), _moved(0.5, 0, 0)
        ),
        "ogre lattice gap": lambda: by_lattice(
            "ogre lattice gap", model("ogre"), _gap(0.12, 0.75), (6, 5, 5), _moved(1.2, 0.02, 0)
        ),
        "bunny vertices gap": lambda: by_vertices(
            "bunny vertices gap", model("bunny"), _gap(0.35, 0.6), model("bunny").vertices + (1.2, 0.02, 0)
        ),
        "bunny rigid far": lambda: rigidly(
            "bunny rigid far", model("bunny"), [_slab((1.5, 0.2, 0.1), (0.2, 0.9, 0.8))], (6.0, 0, 0), (0, 0, 1.0)
        ),
        "ogre rigid turn": lambda: rigidly(
            "ogre rigid turn", model("ogre"), [_slab((0, 0.5, 0), (2.0, 0.1, 2.0))], (0.3, 0.3, 0), (0, 0, 2.2)
        ),
        "shell on bunny": lambda: by_vertices(
            "shell on bunny",
            _shell(1.0, 24).moved((0, 0, 0.55)),
            [model("bunny")],
            _shell(1.0, 24).vertices - (0, 0, 0.1),
        ),
        "shell cage on ogre": lambda: by_cage(
            "shell cage on ogre", _shell(1.2, 7).moved((0, 0, 0.6)), 2, [model("ogre")], _moved(0, 0, -0.7)
        ),
        "ball cage in bars": lambda: by_cage(
            "ball cage in bars", triangulated(icosphere(2, 0.35)), 2, _bars(5, 0.6), _moved(0.9, 0.03, 0)
        ),
        "torus cage on bunny": lambda: by_cage(
            "torus cage on bunny",
            triangulated(torus(12, 6, 0.3, 0.08)).moved((0, 0, 0.7)),
            2,
            [model("bunny")],
            _moved(0.02, 0, -0.6),
        ),
        "bunny handles": bunny_handles,
        "ogre arm": ogre_arm,
        "bunny grown": grown,
        "ogre bent": bent,
        "ogre rigid gap": lambda: rigidly(
            "ogre rigid gap", model("ogre"), _gap(0.22, 0.8), (1.8, 0.1, 0.02), (0.1, 0, 0.2)
        ),
        "bunny rigid bars": lambda: rigidly(
            "bunny rigid bars", model("bunny"), _bars(3, 0.8), (3.0, 0.1, 0), (0, 0.3, 0)
        ),
        "ogre vertices wall": lambda: by_vertices(
            "ogre vertices wall",
            model("ogre"),
            [_slab((0, 0.45, 0), (2.0, 0.1, 2.0))],
            model("ogre").vertices + (0.0, 0.35, 0),
        ),
    }
    return every
