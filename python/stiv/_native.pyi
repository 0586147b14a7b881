# SPDX-License-Identifier: GPL-3.0-or-later
# Types of the compiled module; what it does is documented by the modules of the package that use it.
import enum

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Indices = NDArray[np.int32]

class InputError(ValueError): ...

class StartIntersectsError(InputError):
    pairs: _Indices

class Surface:
    def __init__(
        self,
        vertex_count: int,
        triangles: _Indices,
        loose_edges: _Indices,
        vertex_body: list[int],
        bodies: list[tuple[str, str]],
        ignored: list[tuple[int, int]],
    ) -> None: ...
    @property
    def edges(self) -> _Indices: ...
    def describe_vertex(self, vertex: int) -> str: ...
    def describe_triangle(self, triangle: int) -> str: ...
    def vertex_areas(self, positions: _Floats) -> _Floats: ...

class EventKind(enum.Enum):
    vf = 0
    ee = 1

class BroadPhase(enum.Enum):
    bvh = 0
    brute_force = 1

_EventArrays = tuple[NDArray[np.uint8], _Indices, _Floats, _Floats, _Floats, _Floats]

def times_of_impact(kind: EventKind, start: _Floats, end: _Floats, separation: float, threads: int) -> _Floats: ...

class Detector:
    def __init__(self, surface: Surface, broad_phase: BroadPhase, threads: int) -> None: ...
    def find(self, start: _Floats, end: _Floats, separation: float, keep: float) -> _EventArrays: ...
    def earliest_time(self, start: _Floats, end: _Floats, separation: float, keep: float) -> float: ...

def find_intersections(surface: Surface, positions: _Floats, threads: int) -> _Indices: ...
def find_loose_intersections(surface: Surface, positions: _Floats, threads: int) -> tuple[_Indices, _Indices]: ...
def is_step_free(surface: Surface, start: _Floats, end: _Floats, separation: float, threads: int) -> bool: ...
