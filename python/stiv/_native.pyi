# SPDX-License-Identifier: GPL-3.0-or-later
# Types of the compiled module; what it does is documented by the modules of the package that use it.
import enum
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Indices = NDArray[np.int32]

class InputError(ValueError): ...

class StartIntersectsError(InputError):
    pairs: _Indices

class VectorTarget(enum.Enum):
    baseline = 0
    avx2 = 1
    avx512 = 2

def best_vector_target() -> VectorTarget: ...
def vector_target() -> VectorTarget: ...
def limit_vector_target(most: VectorTarget) -> None: ...

class Surface:
    def __init__(
        self,
        vertex_count: int,
        triangles: _Indices,
        loose_edges: _Indices,
        vertex_body: list[int],
        bodies: list[tuple[str, str]],
        ignored: list[tuple[int, int]],
        recut_faces: list[list[int]],
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
    hash_grid = 1
    brute_force = 2

class NarrowPhase(enum.Enum):
    conservative = 0
    polynomial = 1

_EventArrays = tuple[NDArray[np.uint8], _Indices, _Floats, _Floats, _Floats, _Floats]

def times_of_impact(kind: EventKind, start: _Floats, end: _Floats, separation: float, threads: int) -> _Floats: ...

class Detector:
    def __init__(self, surface: Surface, broad_phase: BroadPhase, narrow_phase: NarrowPhase, threads: int) -> None: ...
    def find(self, start: _Floats, end: _Floats, separation: float, keep: float) -> _EventArrays: ...
    def earliest_time(self, start: _Floats, end: _Floats, separation: float, keep: float) -> float: ...

def find_intersections(surface: Surface, positions: _Floats, threads: int) -> _Indices: ...
def find_loose_intersections(surface: Surface, positions: _Floats, threads: int) -> tuple[_Indices, _Indices]: ...
def is_step_free(surface: Surface, start: _Floats, end: _Floats, separation: float, threads: int) -> bool: ...

class IntersectionTest:
    def __init__(self, surface: Surface, threads: int) -> None: ...
    def find(self, vertices: _Floats) -> _Indices: ...

class StepCheck:
    def __init__(self, surface: Surface, threads: int) -> None: ...
    def is_free(self, start: _Floats, end: _Floats, separation: float) -> bool: ...

class Deformation:
    @property
    def control_count(self) -> int: ...
    @property
    def vertex_count(self) -> int: ...
    @property
    def rotation_rows(self) -> list[int]: ...
    def surface(self, controls: _Floats) -> _Floats: ...
    def pull_back(self, controls: _Floats, covector: _Floats) -> _Floats: ...
    def push_forward(self, controls: _Floats, motion: _Floats) -> _Floats: ...
    def apply_inverse_metric(
        self,
        controls: _Floats,
        covector: _Floats,
        smoothness: float = 0.1,
        weights: _Floats = ...,
        weight_axes: Sequence[_Floats] = ...,
    ) -> _Floats: ...
    def support(self, control: int) -> list[int]: ...

_Rows = tuple[_Indices, _Indices, _Floats, tuple[int, int]]

def identity(vertex_count: int) -> Deformation: ...
def linear(
    starts: _Indices, controls: _Indices, values: _Floats, control_count: int, offset: _Floats
) -> Deformation: ...
def linear_parts(deformation: Deformation) -> tuple[_Rows, _Floats] | None: ...
def rigid(rest: _Floats) -> Deformation: ...
def rigid_rest_controls(rest: _Floats) -> _Floats: ...
def scaling(rest: _Floats, rotation: _Floats) -> Deformation: ...
def scaling_rest_controls(rest: _Floats) -> _Floats: ...
def concatenate(parts: list[tuple[Deformation, _Indices]], start: _Floats) -> Deformation: ...

class Handles:
    def __init__(
        self,
        rest: _Floats,
        triangles: _Indices,
        handles: _Indices,
        pull: _Floats,
        fixed: _Indices,
        edge_weights: str,
    ) -> None: ...

def laplacian(handles: Handles) -> Deformation: ...
def arap(handles: Handles) -> Deformation: ...
def stored_mesh(mesh: Deformation, frame: _Floats) -> Deformation: ...
def compose(outer: Deformation, inner: Deformation) -> Deformation: ...

class Cage:
    def __init__(
        self,
        vertex_count: int,
        edges: _Indices,
        corners: _Indices,
        starts: _Indices,
        edge_crease: NDArray[np.float32],
        vertex_crease: NDArray[np.float32],
    ) -> None: ...

def subdivision_weights(
    cage: Cage, levels: int, limit_surface: bool, quality: int, simple: bool, boundary: str, scheme: str
) -> _Rows: ...
def subdivided_faces(cage: Cage, levels: int) -> _Indices: ...
def subdivided_triangles(cage: Cage, levels: int) -> _Indices: ...

class Lattice:
    def __init__(
        self, resolution: list[int], interpolation: list[str], rest: _Floats, point_weights: _Floats
    ) -> None: ...

def lattice_weights(lattice: Lattice, vertices: _Floats, influence: _Floats) -> _Rows: ...
def lattice(
    lattice: Lattice, rest_vertices: _Floats, influence: _Floats, vertices: _Floats, points: _Floats
) -> Deformation: ...

class ConstraintKind(enum.Enum):
    per_patch = 0
    single = 1

_Nearest = tuple[float, list[int], _Floats]

def least_distance(surface: Surface, q: _Floats, within: bool) -> _Nearest | None: ...

class BodyPairSeparation:
    def __init__(self, first: int, second: int, separation: float) -> None: ...

class ConstraintSolver(enum.Enum):
    lcp = 0
    linear = 1

class MetricKind(enum.Enum):
    energy = 0
    controls = 1

class VolumeKind(enum.Enum):
    relative = 0
    published = 1
    published_frozen = 2

class StorageFrame:
    def __init__(self, first: int, count: int, frame: _Floats) -> None: ...

class EditOptions:
    def __init__(self) -> None: ...

class CancelToken:
    """Asks a solve to stop; may be used from any thread."""

    def __init__(self) -> None: ...
    def cancel(self) -> None: ...
    @property
    def cancelled(self) -> bool: ...

class EditSession:
    def __init__(self, surface: Surface, deformation: Deformation, controls: _Floats, options: EditOptions) -> None: ...
    def edit(
        self, goal: _Floats, cancel: CancelToken | None, progress: Callable[[str, float], None] | None
    ) -> dict[str, Any]: ...
    def drag(
        self,
        goal: _Floats,
        cancel: CancelToken | None,
        progress: Callable[[str, float], None] | None,
        time_budget: float | None,
    ) -> dict[str, Any]: ...
    def settle(self, cancel: CancelToken | None, progress: Callable[[str, float], None] | None) -> dict[str, Any]: ...
    def is_step_free(self, start: _Floats, end: _Floats) -> bool: ...
    def least_distance(self, within: bool) -> _Nearest | None: ...
    def restore(self, controls: _Floats, goal: _Floats | None) -> None: ...
    @property
    def controls(self) -> _Floats: ...
    @property
    def surface(self) -> _Floats: ...
    @property
    def separation(self) -> float: ...

class ContractionOptions:
    storage: list[StorageFrame]
    def __init__(self) -> None: ...

class RepairOptions:
    contraction: ContractionOptions
    edit: EditOptions
    moves: list[int]
    good_deviation: float
    max_deviation: float
    def __init__(self) -> None: ...

def contraction_step(
    surface: Surface, start: _Floats, positions: _Floats, moves: list[int], smoothing: float
) -> _Floats: ...
def contract(
    surface: Surface,
    deformation: Deformation | None,
    cage: Surface | None,
    positions: _Floats,
    moves: list[int],
    options: ContractionOptions,
    threads: int,
    cancel: CancelToken | None,
    progress: Callable[[str, float], None] | None,
) -> dict[str, Any]: ...
def expand(
    surface: Surface,
    deformation: Deformation | None,
    positions: _Floats,
    target: _Floats,
    options: EditOptions,
    cancel: CancelToken | None,
    progress: Callable[[str, float], None] | None,
) -> dict[str, Any]: ...
def repair(
    surface: Surface,
    deformation: Deformation | None,
    cage: Surface | None,
    positions: _Floats,
    options: RepairOptions,
    cancel: CancelToken | None,
    progress: Callable[[str, float], None] | None,
) -> dict[str, Any]: ...
