# SPDX-License-Identifier: GPL-3.0-or-later
"""A drag of 50 thousand triangles over a landscape of millions that never moves.

The landscape is an obstacle of the session (`stiv.Obstacle`), or for comparison a fixed body of its surface. A body in
a lattice is moved to the ground and along it, one call of `drag` a tick. Vector code is limited to AVX2, which most
users have. Times of the start include checking and storing the landscape. Memory is the growth of the resident set
beyond the landscape's arrays, at its peak.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stiv
from benchmarks.sessions.running import Array, Report
from blend_fixtures.scenes.detection_steps import rounded_box
from stiv import _native

Indices = NDArray[np.int32]

SIDE = 20.0  #: of the landscape; the body has radius 1
CUTS = 65  #: of the body: 50,700 triangles
TICKS = 60
SIZES = (1_000_000, 10_000_000)  #: triangles of the landscape
HEIGHT = 1.35  #: of the body's center above the landscape's middle, at the start
SINKING, ADVANCE = 0.012, 0.05  #: of the goal in a tick
MAX_BODY = 1_200_000  #: triangles; a larger landscape is not measured as a body of the surface


@dataclass(frozen=True)
class Mesh:
    """Vertices (n, 3) and triangles (f, 3)."""

    vertices: Array
    faces: Indices


def landscape(triangles: int) -> Mesh:
    """Hills of about this many triangles, row by row."""
    cells = round((triangles / 2) ** 0.5)
    along = np.linspace(-SIDE / 2, SIDE / 2, cells + 1)
    x, y = (each.ravel() for each in np.meshgrid(along, along, indexing="ij"))
    vertices = np.column_stack([x, y, 0.25 * np.sin(1.7 * x) * np.cos(1.3 * y)])
    first = (np.arange(cells, dtype=np.int32)[:, None] * (cells + 1) + np.arange(cells, dtype=np.int32)).ravel()
    corners = np.stack([first, first + cells + 1, first + cells + 2, first, first + cells + 2, first + 1], axis=1)
    return Mesh(vertices, corners.reshape(-1, 3))


@dataclass(frozen=True)
class Ticks:
    """Seconds of a drag, and the growth of memory in bytes."""

    start: float  #: checking and storing the landscape, and opening the session
    clock: Array  #: of each tick
    processor: Array
    memory: int
    touched: int  #: ticks with contacts
    intersections: int  #: pairs of triangles in the last state, by the exact test


def large_scene(threads: Sequence[int], largest: int, report: Report) -> list[dict[str, Any]]:
    """One row for each size of the landscape, way to give it and number of threads."""
    rows = []
    for triangles in (size for size in SIZES if size <= largest):
        for given in ("obstacle", "body") if triangles <= MAX_BODY else ("obstacle",):
            for count in threads:
                # In a process of its own, so that no memory of another row is used again.
                with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as alone:
                    rows.append(alone.submit(measure, triangles, given, count, TICKS, CUTS).result())
                report(f"{triangles} triangles as {given}, {count} threads")
    return rows


def measure(triangles: int, given: str, threads: int, ticks: int, cuts: int) -> dict[str, Any]:
    """One row."""
    ground = landscape(triangles)
    with _limited_vectors() as vectors:
        measured = _drag(ground, given, threads, ticks, cuts)
    return {**_row(ground, given, threads, vectors, measured), "moving_triangles": 12 * cuts**2}


def _row(ground: Mesh, given: str, threads: int, vectors: str, ticks: Ticks) -> dict[str, Any]:
    later = 1000 * ticks.clock[1:]
    return {
        "scene": f"landscape as {given}",
        "threads": threads,
        "vectors": vectors,
        "static_triangles": len(ground.faces),
        "ticks": len(ticks.clock),
        "ticks_with_contacts": ticks.touched,
        "first_tick_ms": 1000 * (ticks.start + ticks.clock[0]),
        "clock_ms_median": float(np.median(later)),
        "clock_ms_95": float(np.percentile(later, 95)),
        "clock_ms_max": float(later.max()),
        "processor_ms_median": 1000 * float(np.median(ticks.processor[1:])),
        "memory_mb": ticks.memory / 1e6,
        "bytes_per_static_triangle": ticks.memory / len(ground.faces),
        "intersections": ticks.intersections,
    }


def _drag(ground: Mesh, given: str, threads: int, ticks: int, cuts: int) -> Ticks:
    shape = rounded_box(cuts, 0.1).moved((-2.0, -1.0, HEIGHT))
    body = Mesh(shape.vertices, shape.triangles())
    frame = np.diag([2.4, 2.4, 2.4, 1.0])
    frame[:3, 3] = (-2.0, -1.0, HEIGHT)
    weights = stiv.lattice(body.vertices, (6, 6, 6), frame=frame)
    controls = stiv.lattice_rest_points((6, 6, 6)) @ frame[:3, :3].T + frame[:3, 3]
    options = stiv.EditOptions(threads=threads)
    before = _resident("VmRSS")
    _reset_peak()
    began = time.perf_counter()
    session = (_with_obstacle if given == "obstacle" else _with_body)(ground, body, weights, controls, options)
    start = time.perf_counter() - began
    clock, processor, touched = [], [], 0
    for tick in range(1, ticks + 1):
        goal = controls + np.array([ADVANCE, 0.6 * ADVANCE, -SINKING]) * [tick, tick, min(tick, 40)]
        clocked, used = time.perf_counter(), time.process_time()
        result = session.drag(goal)
        clock.append(time.perf_counter() - clocked)
        processor.append(time.process_time() - used)
        touched += len(result.events) > 0
    memory = _resident("VmHWM") - before
    return Ticks(
        start, np.array(clock), np.array(processor), memory, touched, _intersections(result.surface, ground, body)
    )


def _with_obstacle(
    ground: Mesh, body: Mesh, deformation: stiv.Deformation, controls: Array, options: stiv.EditOptions
) -> stiv.EditSession:
    obstacle = stiv.Obstacle(ground.vertices, ground.faces, "Landscape")
    surface = stiv.Surface(body.faces, len(body.vertices), bodies=[stiv.Body("Body")])
    return stiv.EditSession(surface, deformation, controls, options, [obstacle])


def _with_body(
    ground: Mesh, body: Mesh, deformation: stiv.Deformation, controls: Array, options: stiv.EditOptions
) -> stiv.EditSession:
    count = len(body.vertices)
    start = np.concatenate([body.vertices, ground.vertices])
    surface = stiv.Surface(
        np.concatenate([body.faces, ground.faces + count]),
        len(start),
        vertex_body=np.repeat([0, 1], [count, len(ground.vertices)]),
        bodies=[stiv.Body("Body"), stiv.Body("Landscape", "fixed")],
    )
    return stiv.EditSession(surface, stiv.concatenate([(deformation, np.arange(count))], start), controls, options)


def _intersections(surface: Array, ground: Mesh, body: Mesh) -> int:
    """Pairs of triangles of the moved body and the landscape below it that intersect; independent of the session."""
    moved = surface[: len(body.vertices)]
    low, high = moved.min(axis=0), moved.max(axis=0)
    sides = ((ground.vertices < low) | (ground.vertices > high)).any(axis=1)
    near = ground.faces[~sides[ground.faces].all(axis=1)]
    used, places = np.unique(near, return_inverse=True)
    triangles = np.concatenate([body.faces, places.reshape(-1, 3) + len(moved)])
    return len(stiv.find_intersections(np.concatenate([moved, ground.vertices[used]]), triangles))


@contextmanager
def _limited_vectors() -> Iterator[str]:
    """Limits vector code to AVX2 for a while, and gives the name of the target in use."""
    _native.limit_vector_target(_native.VectorTarget.avx2)
    try:
        yield _native.vector_target().name
    finally:
        _native.limit_vector_target(_native.best_vector_target())


def _resident(field: str) -> int:
    """Bytes of a field of the process's status; Linux only."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith(field))


def _reset_peak() -> None:
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def large_scene_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per row."""
    lines = [
        f"{'static':>10} {'given as':>9} {'threads':>7} {'first ms':>9} {'median ms':>9} {'95 % ms':>8} {'max ms':>7} "
        f"{'cpu ms':>7} {'MB':>6} {'B/triangle':>10} {'touched':>7}"
    ]
    lines += [
        f"{r['static_triangles']:10d} {r['scene'].rsplit(' ', 1)[1]:>9} {r['threads']:7d} {r['first_tick_ms']:9.0f} "
        f"{r['clock_ms_median']:9.1f} {r['clock_ms_95']:8.1f} {r['clock_ms_max']:7.1f} {r['processor_ms_median']:7.1f} "
        f"{r['memory_mb']:6.0f} {r['bytes_per_static_triangle']:10.0f} {r['ticks_with_contacts']:7d}"
        for r in rows
    ]
    return "\n".join(lines)
