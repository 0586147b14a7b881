# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs objects into a container: one by one, each falls from the place where it comes to rest lowest."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import permutations, product
from typing import Any

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from stiv import InputError
from stiv.blender.controls.rotations import rotation_matrix, rotation_vector
from stiv.blender.layout.containment import is_closed, winding_numbers
from stiv.blender.layout.layout_edit import LayoutEdit
from stiv.blender.layout.layout_task import LayoutReport, LayoutTask, Watch, run
from stiv.blender.layout.resting import fall
from stiv.blender.layout.rigid_contacts import is_clear
from stiv.blender.layout.rigid_scene import RigidScene
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.settings import EditSettings
from stiv.task import Steps
from stiv.task import run as run_steps

GRID = 32  # cells of the heights of a container
MAX_HITS = 16  # of a vertical line with a container
SHRINKING = 0.9  # of the scale, for each attempt
MAX_ATTEMPTS = 16
DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class FitSettings:
    """How `fit_into` works.

    Attributes:
        edit: the minimum distances, roles and guard; its time_budget limits the whole call.
        container: "inside" (of the closed mesh), "box" (the bounding box, open above), or "auto": inside if the center
            of a closed mesh is inside it, otherwise the box.
        turn: try orientations along the axes of the world.
        scale: scale all objects down uniformly until everything fits.
        tries: places and orientations tried for each object.
        seed: of the random places.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    container: str = "auto"
    turn: bool = True
    scale: bool = False
    tries: int = 60
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse unknown choices."""
        if self.container not in ("auto", "inside", "box"):
            raise InputError(f"container: {self.container!r} is none of auto, inside, box")
        if self.tries < 1:
            raise InputError(f"tries: {self.tries} must be at least 1")


@dataclass(frozen=True)
class Container:
    """Where objects go.

    Attributes:
        box: lowest and highest corner, (2, 3).
        inside: triangles of the closed mesh whose inside it is, (f, 3); None for the box.
        floor, ceiling: ends of the vertical room on a grid over the box, (k, k); an infinite floor means no room.
    """

    box: Floats
    inside: Indices | None
    floor: Floats
    ceiling: Floats


class FitInto(LayoutTask):
    """Packs the other selected objects into the active object."""

    def __init__(self, context: bpy.types.Context, settings: FitSettings) -> None:
        """Read the scene. Raises InputError, also without a container that has a surface."""
        super().__init__(settings.edit.time_budget)
        if context.mode != "OBJECT":
            raise InputError("works in Object Mode; leave the present mode")
        container = context.view_layer.objects.active
        objects = [ob for ob in context.selected_objects if ob != container]
        if container is None or not objects:
            raise InputError("select the objects to pack, then the container as the active object")
        self._settings, self._context = settings, context
        self._edit = LayoutEdit(context, settings.edit, objects)
        self._container = _container(self._edit, container.name, settings.container)
        self._scale, self._left, self._fits = 1.0, list[int](), True
        self._scene = self._edit.scene
        if settings.scale:
            _check_scales(self._edit)

    def _solve(self, watch: Watch) -> Steps[None]:
        count = len(self._edit.control_sets)
        for attempt in range(MAX_ATTEMPTS if self._settings.scale else 1):
            self._scale = SHRINKING**attempt
            self._scene = self._edit.scene.with_scaled_movers(self._scale)
            self._left = yield from _pack(self._scene, range(count), self._container, self._settings, watch)
            if not self._left:
                return
        self._fits = not self._settings.scale

    def _write(self) -> LayoutReport:
        names = [mover.name for mover in self._scene.movers]
        left = [(names[k], "no room") for k in self._left]
        left += [(name, "no surface") for name in self._edit.without_surface]
        packed = [k for k in range(len(names)) if self._fits and k not in self._left]
        if not packed:
            self._scale = 1.0
        else:
            self._edit.write_scaled(self._context, self._scene, self._scale)
        return LayoutReport(
            "done" if packed else "unchanged",
            tuple(names[k] for k in packed),
            tuple(left),
            asked=len(names),
            scale=self._scale,
        )

    def restore(self) -> None:
        """Restore the objects exactly."""
        self._edit.restore()


def _container(edit: LayoutEdit, name: str, choice: str) -> Container:
    meshes = [k for k, mesh in enumerate(edit.assembly.meshes) if mesh.owner.name == name]
    if not meshes:
        raise InputError(f"{name}: has no surface; choose another container")
    rows = edit.assembly.vertices_of(meshes)
    points = edit.assembly.positions[rows]
    box = np.stack([points.min(axis=0), points.max(axis=0)])
    chosen = np.isin(edit.assembly.surface.triangles[:, 0], rows)
    triangles = edit.assembly.surface.triangles[chosen]
    closed = is_closed(triangles)
    if choice == "inside" and not closed:
        raise InputError(f"{name}: is not closed; close it, or use its bounding box")
    if choice == "auto" and closed:
        center = run_steps(winding_numbers(box.mean(axis=0)[None], edit.assembly.positions[triangles]))
        closed = abs(float(center[0])) > 0.5
    inside = triangles if closed and choice != "box" else None
    floor, ceiling = _columns(edit.assembly.positions, triangles, box, inside is not None)
    return Container(box, inside, floor, ceiling)


def _columns(positions: Floats, triangles: Indices, box: Floats, inside: bool) -> tuple[Floats, Floats]:
    """Lower and upper ends, (k, k) each, of the longest vertical room on a grid over a box, (2, 3).

    Room is inside the surface, or above it. Beside the surface the lower end is infinite.
    """
    tree = BVHTree.FromPolygons(positions.tolist(), triangles.tolist())
    axes = [np.linspace(box[0, k], box[1, k], 2 * GRID + 1)[1::2] for k in range(2)]
    floor, ceiling = np.full((GRID, GRID), np.inf), np.full((GRID, GRID), np.inf)
    for (i, x), (j, y) in product(enumerate(axes[0]), enumerate(axes[1])):
        hits = _hits_below(tree, float(x), float(y), box)
        rooms = [(low, high) for high, low in zip(hits[::2], hits[1::2], strict=False)]
        if inside and rooms:
            floor[i, j], ceiling[i, j] = max(rooms, key=lambda room: room[1] - room[0])
        elif not inside and hits:
            floor[i, j] = hits[0]
    return floor, ceiling


def _hits_below(tree: BVHTree, x: float, y: float, box: Floats) -> list[float]:
    """Heights at which a vertical line meets a surface, falling."""
    hits: list[float] = []
    z, step = float(box[1, 2]) + 1.0, 1e-5 * float(np.ptp(box[:, 2]))
    while len(hits) < MAX_HITS:
        hit = tree.ray_cast((x, y, z), (0, 0, -1))[0]
        if hit is None:
            break
        hits.append(hit.z)
        z = hit.z - step
    return hits


def _check_scales(edit: LayoutEdit) -> None:
    for control_set in edit.control_sets:
        if len(control_set.names) > 1:
            raise InputError(f"{control_set.names[0]}: moves with {control_set.names[1]}; pack without scaling")
        if any(bpy.data.objects[control_set.names[0]].lock_scale):
            raise InputError(f"{control_set.names[0]}: its scale is locked; unlock it")


def _pack(
    scene: RigidScene, movers: range, container: Container, settings: FitSettings, watch: Watch
) -> Steps[list[int]]:
    """Steps that pack movers, larger ones first; they return those that do not fit, which stay at their start."""
    order = sorted(movers, key=lambda k: -float(np.prod(np.ptp(scene.box(k), axis=0))))
    waiting, left = list(order), []
    for number, mover in enumerate(order):
        yield from watch.at(scene.movers[mover].name, number / len(order))
        waiting.remove(mover)
        scene.leave_out(waiting)  # they have no place yet
        if not (yield from _pack_one(scene, mover, container, settings, number, watch)):
            left.append(mover)
    scene.leave_out([])
    return left


def _pack_one(
    scene: RigidScene, mover: int, container: Container, settings: FitSettings, number: int, watch: Watch
) -> Steps[bool]:
    start, best = scene.pose(mover), None
    lowest = np.inf
    for pose, expected in (yield from _candidates(scene, mover, container, settings, number, watch)):
        yield from watch.check()
        if expected >= lowest:
            break
        scene.set_pose(mover, pose)
        if not is_clear(scene, mover) or not (yield from _is_inside(scene, mover, container, falling=True)):
            continue
        if (yield from fall(scene, mover, DOWN)) is None or not (yield from _is_inside(scene, mover, container)):
            continue
        top = float(scene.box(mover)[1, 2])
        if top < lowest - 1e-9:
            lowest, best = top, scene.pose(mover)
    scene.set_pose(mover, start if best is None else best)
    return best is not None


def _candidates(
    scene: RigidScene, mover: int, container: Container, settings: FitSettings, number: int, watch: Watch
) -> Steps[list[tuple[Floats, float]]]:
    """Steps that find poses from which a mover may fall.

    Each has the height of the mover's top after the fall if all below were boxes, rising.
    """
    rng = np.random.default_rng([settings.seed, number])
    free = scene.movers[mover]
    turns = _orientations(rng) if settings.turn and free.can_turn else [np.zeros(3)]
    base, gap = scene.pose(mover), 1.01 * scene.largest_separation
    found: list[tuple[float, float, Floats]] = []
    for turn in turns:
        yield from watch.check()
        pose = base.copy()
        pose[1] = rotation_vector(rotation_matrix(turn) @ rotation_matrix(base[1]))
        scene.set_pose(mover, pose)
        box = scene.box(mover)
        size = box[1] - box[0]
        low, high = container.box[0] + gap, container.box[1] - gap - size
        if (high[:2] < low[:2]).any() or size[2] > container.box[1, 2] - container.box[0, 2]:
            continue
        for x, y in _places(low[:2], high[:2], settings.tries, rng):
            rest, start = _expected_rest(scene, mover, np.array([x, y]), size, container)
            if not np.isfinite(rest) or start - gap < rest:
                continue
            moved = pose.copy()
            moved[0] += [x, y, start] - box[0]
            found.append((rest + size[2], len(found), moved))
    scene.set_pose(mover, base)
    found.sort(key=lambda each: each[:2])
    return [(pose, top) for top, _, pose in found[: settings.tries]]


def _orientations(rng: np.random.Generator) -> list[Floats]:
    """The 24 rotations that map axes to axes, the present orientation first."""
    found = []
    for order, signs in product(permutations(range(3)), product((1, -1), repeat=3)):
        matrix = np.zeros((3, 3))
        matrix[range(3), order] = signs
        if np.linalg.det(matrix) > 0:
            found.append(rotation_vector(matrix))
    return found


def _places(low: Floats, high: Floats, tries: int, rng: np.random.Generator) -> Floats:
    """Corners of boxes: a grid with the borders, and random places, (k, 2)."""
    side = max(2, int(np.sqrt(tries / 2)))
    axes = [np.linspace(low[k], high[k], side) for k in range(2)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    return np.concatenate([grid, low + (high - low) * rng.random((tries // 4, 2))])


def _expected_rest(
    scene: RigidScene, mover: int, corner: Floats, size: Floats, container: Container
) -> tuple[float, float]:
    """Heights at which a box with this lower corner, (2,), would rest on the boxes of packed movers, and start."""
    gap, extent = 1.01 * scene.largest_separation, container.box[1, :2] - container.box[0, :2]
    first = np.floor((corner - container.box[0, :2]) / extent * GRID).astype(int)
    last = np.ceil((corner + size[:2] - container.box[0, :2]) / extent * GRID).astype(int)
    cells = np.s_[first[0] : last[0], first[1] : last[1]]
    height = float(container.floor[cells].max(initial=-np.inf))
    start = float(container.ceiling[cells].min(initial=np.inf)) - size[2] - gap
    for other in scene.shown_movers(mover):
        low, high = scene.box(other)
        if (corner < high[:2]).all() and (corner + size[:2] > low[:2]).all():
            height = max(height, float(high[2]))
    return height, start if np.isfinite(start) else float(container.box[1, 2]) + gap


def _is_inside(scene: RigidScene, mover: int, container: Container, falling: bool = False) -> Steps[bool]:
    """Steps that tell whether a mover is within the container, or over an open box while it falls."""
    low, high = scene.box(mover)
    inside = (low >= container.box[0]).all() and (high[:2] <= container.box[1, :2]).all()
    if container.inside is None:
        return bool(inside and (falling or high[2] <= container.box[1, 2]))
    if not inside or high[2] > container.box[1, 2]:
        return False
    windings = yield from winding_numbers(scene.components(mover), scene.corners(container.inside))
    return bool((np.abs(windings) > 0.5).all())


def fit_into(context: bpy.types.Context, settings: FitSettings | None = None, **execution: Any) -> LayoutReport:
    """Pack the selected objects into the active one.

    `cancel` and `progress` are those of stiv.EditSession. Raises InputError, with nothing changed.
    """
    return run(FitInto(context, settings or FitSettings()), **execution)
