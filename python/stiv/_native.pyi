# SPDX-License-Identifier: GPL-3.0-or-later
# Written by tools/native_stub.py.
"""
The native core. Use the package `stiv`, which documents it.
"""

from collections.abc import Sequence
from enum import Enum
from typing import Annotated, Any

from numpy import float32, float64, int32
from numpy.typing import ArrayLike, NDArray

class InputError(ValueError): ...
class InfeasibleError(InputError): ...
class CancelledError(RuntimeError): ...

class StartIntersectsError(InputError):
    pairs: NDArray[int32]

class VectorTarget(Enum):
    baseline = 0
    avx2 = 1
    avx512 = 2

class Job:
    def cancel(self) -> None: ...
    def poll(self) -> tuple[Any, ...]: ...
    def result(self) -> Any: ...
    def wait_for(self, seconds: float) -> bool: ...

class Surface:
    def __init__(
        self,
        vertex_count: int,
        triangles: Annotated[ArrayLike, int32, "[m, 3]"],
        loose_edges: Annotated[ArrayLike, int32, "[m, 2]"],
        vertex_body: Annotated[ArrayLike, int32],
        bodies: Sequence[tuple[str, str]],
        ignored: Sequence[tuple[int, int]],
        flip_faces: Sequence[Sequence[int]],
    ) -> None: ...
    def describe_triangle(self, triangle: int) -> str: ...
    def describe_vertex(self, vertex: int) -> str: ...
    def vertex_areas(
        self, positions: Annotated[NDArray[float64], "[m, 3]"]
    ) -> Annotated[NDArray[float64], "[m, 1]"]: ...
    @property
    def edges(self) -> Annotated[NDArray[int32], "[m, 2]"]: ...

class Obstacle:
    def __init__(
        self,
        name: str,
        positions: Annotated[ArrayLike, float64, "[m, 3]"],
        triangles: Annotated[ArrayLike, int32, "[m, 3]"],
    ) -> None: ...
    def triangles_near(
        self, low: Annotated[ArrayLike, float64, "[3, 1]"], high: Annotated[ArrayLike, float64, "[3, 1]"]
    ) -> NDArray[int32]: ...
    @property
    def positions(self) -> Annotated[NDArray[float64], "[m, 3]"]: ...
    @property
    def triangles(self) -> Annotated[NDArray[int32], "[m, 3]"]: ...

class Deformation:
    """
    Map q = f(p) from controls p, (m, 3), to world positions q of a surface, (n, 3).

    Made by the functions of this package: identity, linear, rigid, ... Immutable and safe to use from any thread.
    """

    def apply_inverse_metric(
        self,
        controls: Annotated[ArrayLike, float64, "[m, 3]"],
        covector: Annotated[ArrayLike, float64, "[m, 3]"],
        smoothness: float = 0.1,
        weights: Annotated[ArrayLike, float64] = ...,
        weight_axes: Sequence[Annotated[ArrayLike, float64, "[3, 3]"]] = [],
    ) -> Annotated[NDArray[float64], "[m, 3]"]:
        """
        Return W^1/2 (J^T J + damping)^-1 W^1/2 g, (m, 3), for a covector g over the controls, (m, 3).

        smoothness   > 0, the damping relative to the diagonal
        weights      (m,) or (m, 3), default 1; 0 pins a control or one of its coordinates
        weight_axes  (m, 3, 3): the three weights of a control act along the columns of a rotation
        """

    def pull_back(
        self, controls: Annotated[ArrayLike, float64, "[m, 3]"], covector: Annotated[ArrayLike, float64, "[m, 3]"]
    ) -> Annotated[NDArray[float64], "[m, 3]"]:
        """
        Return J(p)^T g, (m, 3), for a covector g over the vertices, (n, 3).
        """

    def push_forward(
        self, controls: Annotated[ArrayLike, float64, "[m, 3]"], motion: Annotated[ArrayLike, float64, "[m, 3]"]
    ) -> Annotated[NDArray[float64], "[m, 3]"]:
        """
        Return J(p) d, (n, 3), the velocity of the surface for a motion d of the controls, (m, 3).
        """

    def support(self, control: int) -> list[int]:
        """
        Return the vertices that a control moves, in ascending order.
        """

    def surface(self, controls: Annotated[ArrayLike, float64, "[m, 3]"]) -> Annotated[NDArray[float64], "[m, 3]"]:
        """
        Return the positions f(p), (n, 3), at controls p, (m, 3).
        """

    @property
    def control_count(self) -> int:
        """
        m, the number of rows of the controls.
        """

    @property
    def rotation_rows(self) -> list[int]:
        """
        Rows of the controls that are rotation vectors (radians) instead of points.
        """

    @property
    def vertex_count(self) -> int:
        """
        n, the number of vertices of the surface.
        """

class ObservedDeformation(Deformation):
    def __init__(
        self,
        evaluate: Any,
        starts: Annotated[ArrayLike, int32],
        controls: Annotated[ArrayLike, int32],
        values: Annotated[ArrayLike, float64],
        control_count: int,
        rotation_rows: ArrayLike,
    ) -> None: ...
    def replace_jacobian(
        self,
        starts: Annotated[ArrayLike, int32],
        controls: Annotated[ArrayLike, int32],
        values: Annotated[ArrayLike, float64],
        control_count: int,
    ) -> None: ...
    @property
    def jacobian_revision(self) -> int:
        """
        How often the Jacobian was replaced.
        """

class ScalarDeformation(Deformation):
    def __init__(
        self,
        evaluate: Any,
        jacobian: Annotated[ArrayLike, float64, "[m, n]"],
        lower: Annotated[ArrayLike, float64, "[m, 1]"],
        upper: Annotated[ArrayLike, float64, "[m, 1]"],
        longest_step: Annotated[ArrayLike, float64, "[m, 1]"],
    ) -> None: ...
    def replace_jacobian(self, jacobian: Annotated[ArrayLike, float64, "[m, n]"]) -> None: ...
    @property
    def jacobian_revision(self) -> int:
        """
        How often the Jacobian was replaced.
        """

class Handles:
    def __init__(
        self,
        rest: Annotated[ArrayLike, float64, "[m, 3]"],
        triangles: Annotated[ArrayLike, int32, "[m, 3]"],
        handles: ArrayLike,
        pull: Annotated[ArrayLike, float64, "[m, 1]"],
        fixed: ArrayLike,
        edge_weights: str,
    ) -> None: ...

class Cage:
    def __init__(
        self,
        vertex_count: int,
        edges: Annotated[ArrayLike, int32, "[m, 2]"],
        corners: ArrayLike,
        starts: ArrayLike,
        edge_crease: ArrayLike,
        vertex_crease: ArrayLike,
    ) -> None: ...

class Lattice:
    def __init__(
        self,
        resolution: Annotated[Sequence[int], "FixedSize(3)"],
        interpolation: Annotated[Sequence[str], "FixedSize(3)"],
        rest: Annotated[ArrayLike, float64, "[m, 3]"],
        point_weights: Annotated[ArrayLike, float64, "[m, 1]"],
    ) -> None: ...

class EventKind(Enum):
    vf = 0
    ee = 1

class BroadPhase(Enum):
    bvh = 0
    hash_grid = 1
    brute_force = 2

class NarrowPhase(Enum):
    conservative = 0
    polynomial = 1

class Detector:
    def __init__(self, surface: Surface, broad_phase: BroadPhase, narrow_phase: NarrowPhase, threads: int) -> None: ...
    def earliest_time(
        self,
        start: Annotated[NDArray[float64], "[m, 3]"],
        end: Annotated[NDArray[float64], "[m, 3]"],
        separation: float,
        min_clearance_ratio: float,
    ) -> float: ...
    def find(
        self,
        start: Annotated[NDArray[float64], "[m, 3]"],
        end: Annotated[NDArray[float64], "[m, 3]"],
        separation: float,
        min_clearance_ratio: float,
    ) -> tuple[Any, ...]: ...

class IntersectionTest:
    def __init__(self, surface: Surface, threads: int) -> None: ...
    def find(self, positions: Annotated[NDArray[float64], "[m, 3]"]) -> Annotated[NDArray[int32], "[m, 2]"]: ...

class DeviationTest:
    def is_free(self, positions: Annotated[NDArray[float64], "[m, 3]"], threads: int) -> bool | None: ...
    @property
    def reach(self) -> float: ...

class StepCheck:
    def __init__(self, surface: Surface, threads: int) -> None: ...
    def is_end_free(
        self, start: Annotated[NDArray[float64], "[m, 3]"], end: Annotated[NDArray[float64], "[m, 3]"]
    ) -> bool: ...
    def is_free(
        self,
        start: Annotated[NDArray[float64], "[m, 3]"],
        end: Annotated[NDArray[float64], "[m, 3]"],
        separation: float,
    ) -> bool: ...

class StorageFrame:
    def __init__(self, first: int, count: int, frame: Annotated[ArrayLike, float64, "[4, 4]"]) -> None: ...

class BodyPairSeparation:
    def __init__(self, first: int, second: int, separation: float) -> None: ...

class ConstraintKind(Enum):
    per_patch = 0
    single = 1

class ConstraintSolver(Enum):
    lcp = 0
    linear = 1

class MetricKind(Enum):
    energy = 0
    controls = 1

class VolumeKind(Enum):
    relative = 0
    published = 1
    published_frozen = 2

class EditOptions:
    broad_phase: BroadPhase
    constraints: ConstraintKind
    metric: MetricKind
    narrow_phase: NarrowPhase
    parts_may_cut: bool
    single_precision: bool
    solver: ConstraintSolver
    tight: bool
    volumes: VolumeKind
    accumulated_rounds: int
    exclude: Sequence[tuple[int, int]]
    max_rounds: int
    max_sub_edits: int
    min_clearance_ratio: float
    min_clearance_ratio_between: float
    overlapping: Sequence[tuple[int, int]]
    pair_separations: Sequence[BodyPairSeparation]
    pull_limit: float
    separation: float
    smoothness: float
    storage: Sequence[StorageFrame]
    threads: int
    time_budget: float
    touching: Sequence[int]
    weight_axes: Sequence[Annotated[ArrayLike, float64, "[3, 3]"]]
    weights: Annotated[ArrayLike, float64, "[m, 1]"]

    def __init__(self) -> None: ...

class CancelToken:
    """
    Cancels a call from any thread.
    """

    def __init__(self) -> None: ...
    def cancel(self) -> None: ...
    @property
    def cancelled(self) -> bool: ...

class EditSession:
    @staticmethod
    def start(
        surface: Surface,
        deformation: Deformation,
        controls: Annotated[ArrayLike, float64],
        options: EditOptions,
        obstacles: Sequence[Obstacle],
    ) -> Job: ...
    def __init__(
        self,
        surface: Surface,
        deformation: Deformation,
        controls: Annotated[ArrayLike, float64],
        options: EditOptions,
        obstacles: Sequence[Obstacle],
    ) -> None: ...
    def confirm(self, cancel: CancelToken | None = None, progress: Any = None) -> dict[str, Any]: ...
    def deviation_test(self) -> DeviationTest: ...
    def drag(
        self,
        goal: Annotated[ArrayLike, float64],
        cancel: CancelToken | None = None,
        progress: Any = None,
        time_budget: float | None = None,
        hand_over: float | None = None,
    ) -> dict[str, Any]: ...
    def edit(
        self, goal: Annotated[ArrayLike, float64], cancel: CancelToken | None = None, progress: Any = None
    ) -> dict[str, Any]: ...
    def end_drag(self) -> None: ...
    def is_step_free(
        self, start: Annotated[NDArray[float64], "[m, 3]"], end: Annotated[NDArray[float64], "[m, 3]"]
    ) -> bool: ...
    def least_distance(self, within: bool) -> Any: ...
    def restore(self, controls: Annotated[ArrayLike, float64], goal: Annotated[ArrayLike, float64] | None) -> None: ...
    def set_weights(
        self,
        weights: Annotated[ArrayLike, float64, "[m, 1]"],
        weight_axes: Sequence[Annotated[ArrayLike, float64, "[3, 3]"]],
    ) -> None: ...
    def settle(self, cancel: CancelToken | None = None, progress: Any = None) -> dict[str, Any]: ...
    def start_confirm(self) -> Job: ...
    def start_drag(
        self, goal: Annotated[ArrayLike, float64], time_budget: float | None = None, hand_over: float | None = None
    ) -> Job: ...
    def start_edit(self, goal: Annotated[ArrayLike, float64]) -> Job: ...
    def start_settle(self) -> Job: ...
    @property
    def controls(self) -> Annotated[NDArray[float64], "[m, 3]"]: ...
    @property
    def excluded(self) -> Annotated[NDArray[int32], "[m, 2]"]: ...
    @property
    def separation(self) -> float: ...
    @property
    def surface(self) -> Annotated[NDArray[float64], "[m, 3]"]: ...

class ContractionOptions:
    growth: float
    max_steps: int
    smoothing: float
    storage: Sequence[StorageFrame]
    time_budget: float
    tolerance: float

    def __init__(self) -> None: ...

class RepairOptions:
    contraction: ContractionOptions
    edit: EditOptions
    good_deviation: float
    max_deviation: float
    moves: Sequence[int]

    def __init__(self) -> None: ...

def arap(handles: Handles) -> Deformation: ...
def best_vector_target() -> VectorTarget: ...
def compose(outer: Deformation, inner: Deformation) -> Deformation: ...
def concatenate(
    parts: Sequence[tuple[Deformation, Annotated[ArrayLike, int32]]], start: Annotated[ArrayLike, float64, "[m, 3]"]
) -> Deformation: ...
def contract(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    moves: ArrayLike,
    options: ContractionOptions,
    threads: int,
    deformation: Deformation | None = None,
    cage: Surface | None = None,
    cancel: CancelToken | None = None,
    progress: Any = None,
) -> dict[str, Any]: ...
def contraction_step(
    surface: Surface,
    start: Annotated[ArrayLike, float64, "[m, 3]"],
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    moves: ArrayLike,
    smoothing: float,
) -> Annotated[NDArray[float64], "[m, 3]"]: ...
def expand(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    target: Annotated[ArrayLike, float64, "[m, 3]"],
    options: EditOptions,
    deformation: Deformation | None = None,
    cancel: CancelToken | None = None,
    progress: Any = None,
) -> dict[str, Any]: ...
def find_folded(
    points: Annotated[ArrayLike, float32], corners: Annotated[ArrayLike, int32], cosine: float, narrow: float
) -> NDArray[int32]: ...
def find_intersections(
    surface: Surface, positions: Annotated[NDArray[float64], "[m, 3]"], threads: int
) -> Annotated[NDArray[int32], "[m, 2]"]: ...
def find_loose_intersections(
    surface: Surface, positions: Annotated[NDArray[float64], "[m, 3]"], distance: float, threads: int
) -> tuple[Annotated[NDArray[int32], "[m, 2]"], Annotated[NDArray[int32], "[m, 2]"]]: ...
def identity(vertex_count: int) -> Deformation: ...
def intersection_depths(
    surface: Surface, pairs: Sequence[tuple[int, int]], positions: Annotated[NDArray[float64], "[m, 3]"]
) -> Annotated[NDArray[float64], "[m, 1]"]: ...
def is_step_free(
    surface: Surface,
    start: Annotated[NDArray[float64], "[m, 3]"],
    end: Annotated[NDArray[float64], "[m, 3]"],
    separation: float,
    threads: int,
) -> bool: ...
def laplacian(handles: Handles) -> Deformation: ...
def largest_difference(first: Annotated[ArrayLike, float64], second: Annotated[ArrayLike, float64]) -> float: ...
def lattice(
    lattice: Lattice,
    rest_vertices: Annotated[ArrayLike, float64, "[m, 3]"],
    influence: Annotated[ArrayLike, float64, "[m, 1]"],
    vertices: Annotated[ArrayLike, float64, "[m, 3]"],
    points: Annotated[ArrayLike, float64, "[m, 3]"],
) -> Deformation: ...
def lattice_weights(
    lattice: Lattice,
    vertices: Annotated[ArrayLike, float64, "[m, 3]"],
    influence: Annotated[ArrayLike, float64, "[m, 1]"],
) -> tuple[Any, ...]: ...
def least_distance(
    surface: Surface, positions: Annotated[NDArray[float64], "[m, 3]"], within: bool, obstacles: Sequence[Obstacle]
) -> Any: ...
def limit_vector_target(most: VectorTarget) -> None: ...
def linear(
    starts: Annotated[ArrayLike, int32],
    controls: Annotated[ArrayLike, int32],
    values: Annotated[ArrayLike, float64],
    control_count: int,
    offset: Annotated[ArrayLike, float64, "[m, 3]"],
) -> Deformation: ...
def linear_parts(deformation: Deformation) -> Any: ...
def repair(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    options: RepairOptions,
    deformation: Deformation | None = None,
    cage: Surface | None = None,
    cancel: CancelToken | None = None,
    progress: Any = None,
) -> dict[str, Any]: ...
def rigid(
    rest: Annotated[ArrayLike, float64, "[m, 3]"], pivot: Annotated[ArrayLike, float64, "[3, 1]"] | None = None
) -> Deformation: ...
def rigid_rest_controls(rest: Annotated[ArrayLike, float64, "[m, 3]"]) -> Annotated[NDArray[float64], "[m, 3]"]: ...
def scaling(
    rest: Annotated[ArrayLike, float64, "[m, 3]"], rotation: Annotated[ArrayLike, float64, "[3, 3]"]
) -> Deformation: ...
def scaling_rest_controls(rest: Annotated[ArrayLike, float64, "[m, 3]"]) -> Annotated[NDArray[float64], "[m, 3]"]: ...
def start_contraction(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    moves: ArrayLike,
    options: ContractionOptions,
    threads: int,
    deformation: Deformation | None = None,
    cage: Surface | None = None,
) -> Job: ...
def start_contraction_step(
    surface: Surface,
    start: Annotated[ArrayLike, float64, "[m, 3]"],
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    moves: ArrayLike,
    smoothing: float,
) -> Job: ...
def start_expansion(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    target: Annotated[ArrayLike, float64, "[m, 3]"],
    options: EditOptions,
    deformation: Deformation | None = None,
) -> Job: ...
def start_repair(
    surface: Surface,
    positions: Annotated[ArrayLike, float64, "[m, 3]"],
    options: RepairOptions,
    deformation: Deformation | None = None,
    cage: Surface | None = None,
) -> Job: ...
def stored_mesh(mesh: Deformation, frame: Annotated[ArrayLike, float64, "[4, 4]"]) -> Deformation: ...
def subdivided_faces(cage: Cage, levels: int) -> Annotated[NDArray[int32], "[m, 4]"]: ...
def subdivided_triangles(cage: Cage, levels: int) -> Annotated[NDArray[int32], "[m, 3]"]: ...
def subdivision_weights(
    cage: Cage, levels: int, limit_surface: bool, quality: int, simple: bool, boundary: str, scheme: str
) -> tuple[Any, ...]: ...
def times_of_impact(
    kind: EventKind,
    start: Annotated[ArrayLike, float64, "[m, 12]"],
    end: Annotated[ArrayLike, float64, "[m, 12]"],
    separation: float,
    threads: int,
) -> Annotated[NDArray[float64], "[m, 1]"]: ...
def transform_points(
    map: Annotated[ArrayLike, float64, "[3, 4]"], points: Annotated[ArrayLike, float64]
) -> Annotated[NDArray[float64], "[m, 3]"]: ...
def transform_single_points(
    map: Annotated[ArrayLike, float64, "[3, 4]"], points: Annotated[ArrayLike, float32]
) -> Annotated[NDArray[float64], "[m, 3]"]: ...
def vector_target() -> VectorTarget: ...
