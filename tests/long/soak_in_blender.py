# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten thousand drags in Blender, each an edit of its own that is written, tested, and restored or kept.

    python tests/long/soak_in_blender.py [--drags 10000] [--moves 2] [--seed 1]

A subdivided cage and a ball in a lattice are dragged in turn at a wall: begin, solve, write and test, as the
add-on's drag does without a window. Blocks of drags alternate with a constant block from the same start, whose
results must be identical each time. Memory is the resident set of the process, Blender's part included.

The exit code is 1 if a test rejected a written state, if surfaces intersect after a block, if a constant block
differs, or if memory grows by 0.5 % or more from the second tenth to the last. Needs Blender as a Python module.
"""

import gc
import hashlib
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "blender")]

import bpy  # noqa: E402
import building  # noqa: E402
import numpy as np  # noqa: E402
from process_memory import resident  # noqa: E402
from soak import BLOCK, MOST_GROWTH, parser  # noqa: E402

from stiv.blender import BlenderEdit, EditSettings, check_scene  # noqa: E402

MOVERS = ("Cage", "Lattice")
SETTINGS = EditSettings(threads=1)


def make_scene() -> None:
    """A wall, a cage below Subdivision Surface, and a ball in a lattice."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    building.add_grid("Wall", 24, size=12)
    building.add_modifier(building.add_cube("Cage", location=(-2, 0, 1.2)), "SUBSURF", levels=3)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=0.8, location=(2, 0, 1.2))
    ball = bpy.context.object
    lattice = building.add_lattice("Lattice", (3, 3, 3), location=(2, 0, 1.2))
    lattice.scale = (2, 2, 2)
    building.add_modifier(ball, "LATTICE", object=lattice)
    bpy.context.view_layer.update()


def drag(name: str, chance: np.random.Generator, moves: int, keep: bool) -> bool:
    """Drag the cage's object, or all points of cage or lattice. Returns whether the last state passed the test."""
    in_edit_mode = not keep
    (building.edit_mode if in_edit_mode else building.select)(bpy.data.objects[name])
    if in_edit_mode:
        (bpy.ops.mesh if name == "Cage" else bpy.ops.lattice).select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, SETTINGS, "move")
    goal = np.array([*chance.normal(scale=0.3, size=2), -chance.uniform(0, 1.2)])
    for move in range(1, moves + 1):
        edit.drag(building.shift(*(move / moves * goal)))
        passed = edit.write().passed
    if keep:
        edit.finish()
    else:
        edit.restore()
    if in_edit_mode:
        bpy.ops.object.mode_set(mode="OBJECT")
    return passed


def block(seed: int, drags: int, moves: int) -> tuple[int, str]:
    """One block from the start: the states that were rejected, and a digest of the scene at its end."""
    bpy.data.objects["Cage"].location = (-2, 0, 1.2)
    bpy.context.view_layer.update()
    chance = np.random.default_rng(seed)
    passed = [drag(MOVERS[n % 2], chance, moves, keep=n % 12 == 0) for n in range(drags)]
    return drags - sum(passed), hashlib.sha256(repr(building.snapshot()).encode()).hexdigest()


def growth_of_memory(memory: list[int]) -> float:
    """Growth of the least value from the second tenth to the last one: a leak raises it, a passing buffer does not."""
    tenth = -(-len(memory) // 10)
    return min(memory[-tenth:]) / min(memory[tenth : 2 * tenth] or memory) - 1


def main() -> int:
    """Drag, test and compare."""
    arguments = parser(__doc__.splitlines()[0])
    arguments.add_argument("--seed", type=int, default=1)
    chosen = arguments.parse_args()
    make_scene()
    rejected, intersections, ends, memory, seed = 0, 0, set(), [], chosen.seed
    while len(memory) * 2 * BLOCK < chosen.drags:
        for each in (seed, 0):
            failures, end = block(each, BLOCK, chosen.moves)
            rejected += failures
            intersections += len(check_scene(bpy.context).pairs)
        ends.add(end)
        gc.collect()
        memory.append(resident())
        seed += 1
        print(f"{len(memory) * 2 * BLOCK} drags: {memory[-1] / 1e6:.2f} MB resident", flush=True)
    growth = growth_of_memory(memory)
    print(f"{rejected} rejected, {intersections} intersections, {len(ends)} ends of one block, {100 * growth:+.2f} %")
    return int(rejected > 0 or intersections > 0 or len(ends) > 1 or growth >= MOST_GROWTH)


if __name__ == "__main__":
    raise SystemExit(main())
