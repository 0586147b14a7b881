# SPDX-License-Identifier: GPL-3.0-or-later
"""Refuses modifier stacks that an edit of their mesh cannot follow, with the modifier that is the cause."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.arrays import Singles
from stiv.blender.scene.evaluations import VIEWPORT, is_active
from stiv.blender.scene.mesh_reading import read_cage
from stiv.blender.scene.modifier_stack import SIMULATIONS, modifier_error
from stiv.blender.scene.stack_twin import EvaluatedStack, StackTwin, open_twin

SMALL = (0.0, 0.001, 0.003)  # moves that may not change the topology, in sizes of the mesh
Comparison = Callable[[EvaluatedStack, EvaluatedStack], bool]
LARGE = 0.1  # moves that may not flip quads, as a drag will
FIXED_DIAGONALS = ("FIXED", "FIXED_ALTERNATE")
NO_EFFECT = 1e-6  # greatest motion of a surface without controls, relative to that of all vertices


def check_projections(ob: bpy.types.Object, evaluation: str) -> None:
    """Refuse projections onto other objects: they leave no way out of a contact. Raises InputError."""
    for modifier in ob.modifiers:
        projects = isinstance(modifier, bpy.types.ShrinkwrapModifier) and modifier.target is not None
        if projects and is_active(modifier, ob, evaluation):
            raise modifier_error(ob, modifier.name, "projects", modifier.target.name)


def check_diagonals(ob: bpy.types.Object, twin: StackTwin, moves: list[Singles], agree: Comparison) -> None:
    """Refuse a Triangulate modifier that changes the topology with large moves. Raises InputError.

    twin: of the object. moves: local positions of the vertices, (m, 3), at the start and moved by `LARGE`. agree: do
    two evaluations have the same topology?
    """
    flipping = [
        each.name for each in twin.ob.modifiers
        if isinstance(each, bpy.types.TriangulateModifier)
        and each.show_viewport and each.quad_method not in FIXED_DIAGONALS
    ]  # fmt: skip
    if flipping and not _keeps_topology([twin.evaluate(move) for move in moves], agree):
        raise modifier_error(ob, flipping[0], "flips quads")


def check_twin(ob: bpy.types.Object, twin: StackTwin, moves: list[Singles], agree: Comparison) -> None:
    """Refuse a stack whose topology changes with small moves, or that ignores its vertices. Raises InputError.

    twin: of the object. moves: local positions of the vertices, (m, 3), at the start and moved by `SMALL`. agree: do
    two evaluations have the same topology?
    """
    if not _keeps_topology(found := [twin.evaluate(move) for move in moves], agree):
        name = _first(twin, moves, lambda each: not _keeps_topology(each))
        flips = ob.modifiers[name].type == "TRIANGULATE"
        raise modifier_error(ob, name, "flips quads" if flips else "changes topology")
    if not _has_effect(found, moves):
        name = _first(twin, moves, lambda each: not _has_effect(each, moves))
        raise modifier_error(ob, name, _why_without_effect(ob.modifiers[name]))


def _why_without_effect(modifier: bpy.types.Modifier) -> str:
    if modifier.type in SIMULATIONS:
        return "simulated"
    return "ignores vertices" if modifier.show_viewport else "ignores vertices in renders"


def no_surface_error(ob: bpy.types.Object) -> InputError:
    """The error for an object without a visible surface, with the modifier that removes it, if one does."""
    if ob.type == "MESH" and any(each.show_viewport for each in ob.modifiers):
        with open_twin(ob, bpy.context.scene, VIEWPORT) as twin:
            local = [read_cage(ob)]
            if len(local[0]) > 0 == len(twin.evaluate(local[0]).positions):
                name = _first(twin, local, lambda found: len(found[0].positions) == 0)
                return modifier_error(ob, name, "no surface")
    return InputError(f"{ob.name}: has no surface that deforms; set its deformation to Rigid")


def _keeps_topology(found: list[EvaluatedStack], agree: Comparison = EvaluatedStack.has_topology_of) -> bool:
    return all(agree(each, found[0]) for each in found)


def _has_effect(found: list[EvaluatedStack], moves: list[Singles]) -> bool:
    """Does the surface move with the vertices, as far as the topology stays? Vertices without extent are not moved."""
    moved = np.abs(moves[-1] - moves[0]).max(initial=0.0)
    if moved == 0:
        return True
    alike = all(len(each.positions) == len(found[0].positions) for each in found)
    shown = found[-1].positions - found[0].positions if alike else moves[-1]
    return bool(np.abs(shown).max(initial=0.0) > NO_EFFECT * moved)


def _first(twin: StackTwin, moves: list[Singles], fails: Callable[[list[EvaluatedStack]], bool]) -> str:
    """Name of the first modifier whose result, with those before it, fails."""
    names: list[str] = [each.name for each in twin.ob.modifiers if each.show_viewport]
    twin.show_modifiers(names, False)
    for name in names:
        twin.show_modifiers([name], True)
        if fails([twin.evaluate(move) for move in moves]):
            break
    twin.show_modifiers(names, True)
    return name
