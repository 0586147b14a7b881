# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifier stacks that are understood, as a list of linear stages."""

from dataclasses import dataclass

import bpy

from stiv import InputError
from stiv.blender.scene.evaluations import SHOWN, VIEWPORT, is_active, subdivision_levels
from stiv.blender.scene.references import ObjectReference

# Leave every position as it is, and the vertices' number and order.
POSITION_KEEPING = frozenset({"TRIANGULATE", "WEIGHTED_NORMAL", "NORMAL_EDIT", "UV_PROJECT", "UV_WARP"})

WAYS_OUT = "apply it, disable it in the viewport, let the object respond rigidly, or make it an obstacle"


@dataclass(frozen=True)
class Subdivision:
    """A Subdivision Surface modifier, as one evaluation has it."""

    modifier: str
    levels: int
    limit_surface: bool
    quality: int
    simple: bool
    boundary: str
    use_creases: bool


@dataclass(frozen=True)
class Bending:
    """A Lattice modifier. `vertex_group` is the group's index, None without one."""

    modifier: str
    lattice: ObjectReference
    strength: float
    vertex_group: int | None
    inverted: bool


Stage = Subdivision | Bending


def read_stack(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str = SHOWN) -> list[Stage]:
    """The stages of an evaluation, in order; what does nothing is left out.

    Raises InputError naming object, modifier and ways out for everything that is not understood.
    """
    stages: list[Stage] = []
    triangulated = ""
    for modifier in ob.modifiers:
        if not is_active(modifier, ob, evaluation):
            continue
        if modifier.type == "TRIANGULATE":
            triangulated = modifier.name
        stage = _stage(ob, modifier, scene, evaluation)
        if isinstance(stage, Subdivision):
            _check_subdivision(ob, stage, stages, triangulated)
        if stage is not None:
            stages.append(stage)
    return stages


def refuse(ob: bpy.types.Object, modifier: str, reason: str) -> InputError:
    """The error for a modifier that cannot be followed."""
    return InputError(f'object "{ob.name}", modifier "{modifier}": {reason}; {WAYS_OUT}')


def _stage(ob: bpy.types.Object, modifier: bpy.types.Modifier, scene: bpy.types.Scene, evaluation: str) -> Stage | None:
    if isinstance(modifier, bpy.types.SubsurfModifier):
        return _subdivision(modifier, scene, evaluation)
    if isinstance(modifier, bpy.types.LatticeModifier):
        return _bending(ob, modifier)
    if modifier.type in POSITION_KEEPING:
        return None
    if not is_active(modifier, ob):
        raise _refuse_unseen(ob, modifier, evaluation)
    kind = modifier.bl_rna.name.removesuffix("Modifier").strip()
    raise refuse(ob, modifier.name, f"STIV cannot follow {kind}")


def _refuse_unseen(ob: bpy.types.Object, modifier: bpy.types.Modifier, evaluation: str) -> InputError:
    """The error for a modifier that the user does not see now, short enough for the status bar."""
    if evaluation == VIEWPORT:
        return InputError(f'{ob.name}: Object Mode shows "{modifier.name}"; apply it or use Object Mode')
    return InputError(f'{ob.name}: the render shows "{modifier.name}"; apply it or set Guard to Viewport')


def _subdivision(modifier: bpy.types.SubsurfModifier, scene: bpy.types.Scene, evaluation: str) -> Subdivision | None:
    levels = subdivision_levels(modifier, scene, evaluation)
    if levels == 0:
        return None
    return Subdivision(
        modifier.name,
        levels,
        modifier.use_limit_surface,
        modifier.quality,
        modifier.subdivision_type == "SIMPLE",
        modifier.boundary_smooth.lower(),
        modifier.use_creases,
    )


def _check_subdivision(ob: bpy.types.Object, stage: Subdivision, before: list[Stage], triangulated: str) -> None:
    if any(isinstance(other, Subdivision) for other in before):
        raise refuse(ob, stage.modifier, "is the second subdivision of the stack")
    if triangulated:
        raise refuse(ob, triangulated, "comes before a subdivision")


def _bending(ob: bpy.types.Object, modifier: bpy.types.LatticeModifier) -> Bending | None:
    if modifier.object is None or modifier.strength == 0:
        return None
    group = ob.vertex_groups.get(modifier.vertex_group)
    return Bending(
        modifier.name,
        ObjectReference.of(modifier.object),
        modifier.strength,
        None if group is None else group.index,
        modifier.invert_vertex_group,
    )
