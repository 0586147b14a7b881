# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads supported modifier stacks as a list of linear stages."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from stiv import InputError
from stiv.blender.scene.evaluations import SHOWN, VIEWPORT, is_active, subdivision_levels
from stiv.blender.scene.position_test import keep_positions
from stiv.blender.scene.references import ObjectReference, modifier_title

# Modifiers that change neither the positions nor the number and order of vertices. Others are found by trial.
POSITION_PRESERVING = frozenset({"TRIANGULATE", "WEIGHTED_NORMAL", "NORMAL_EDIT", "UV_PROJECT", "UV_WARP"})
SIMULATIONS = frozenset({"CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT"})
KNOWN = POSITION_PRESERVING | {"SUBSURF", "LATTICE"}

# Why a modifier is refused, and a way out; the message begins with the object, and the modifier's type and name.
MODIFIER_REASONS = {
    "after moving lattice": "follows the moving lattice; apply it",
    "before subdivision": "precedes a subdivision; apply it",
    "changes topology": "changes topology; apply it",
    "deformed lattice": 'deforms it; select "{other}" instead',
    "flips quads": "flips quads; set Quad Method to Fixed",
    "ignores vertices": "hides edits; disable it",
    "ignores vertices in renders": "hides edits; disable in renders",
    "no surface": "shows no surface; disable it",
    "of lattice": "deforms the lattice; apply it",
    "own transform": "depends on its transform; apply it",
    "projects": 'projects onto "{other}"; edit that',
    "same lattice": 'uses "{other}" again; apply it',
    "second subdivision": "is the second; apply the first",
    "shows instances": "shows instances; realize them",
    "simulated": "simulates it; go to its start frame",
    "unsupported": "is not supported; apply it",
}


@dataclass(frozen=True)
class SubdivisionStage:
    """A Subdivision Surface modifier in one evaluation."""

    modifier: str
    levels: int
    limit_surface: bool
    quality: int
    simple: bool
    boundary: str
    use_creases: bool


@dataclass(frozen=True)
class LatticeStage:
    """A Lattice modifier. `vertex_group` is the index of its group, or None."""

    modifier: str
    lattice: ObjectReference
    strength: float
    vertex_group: int | None
    inverted: bool


Stage = SubdivisionStage | LatticeStage


@dataclass(frozen=True)
class StackEnd:
    """The exact end of a stack: its last subdivision, if any, and the modifiers from there on; the others leave all
    positions alone.
    """

    subdivision: SubdivisionStage | None = None
    modifiers: tuple[str, ...] = ()


def read_stack(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str = SHOWN) -> list[Stage]:
    """Read the stages of an evaluation in order; modifiers that leave positions and topology alone are skipped.

    Raises InputError for any other modifier, naming the object, the modifier and a way out.
    """
    stages: list[Stage] = []
    triangulated = ""
    others = [each for each in ob.modifiers if is_active(each, ob, evaluation) and each.type not in KNOWN]
    if others and not keep_positions(ob, scene, evaluation, [each.name for each in others]):
        raise _refusal(ob, others[0], evaluation)
    for modifier in ob.modifiers:
        if not is_active(modifier, ob, evaluation):
            continue
        if modifier.type == "TRIANGULATE":
            triangulated = modifier.name
        stage = _stage(ob, modifier, scene, evaluation)
        if isinstance(stage, SubdivisionStage):
            _check_subdivision(ob, stage, stages, triangulated)
        if stage is not None:
            stages.append(stage)
    return stages


def read_end(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> StackEnd:
    """Read the end of any stack in an evaluation."""
    active = [each for each in ob.modifiers if is_active(each, ob, evaluation)]
    stages = [_stage(ob, each, scene, evaluation) for each in active]
    places = [place for place, stage in enumerate(stages) if isinstance(stage, SubdivisionStage)]
    if not places:
        return StackEnd(None, _last_preserving(active))
    subdivision = stages[places[-1]]
    assert isinstance(subdivision, SubdivisionStage)
    end = active[places[-1] :]
    unknown = [each.name for each in end[1:] if each.type not in POSITION_PRESERVING]
    if unknown and not keep_positions(ob, scene, evaluation, unknown):
        return StackEnd()
    return StackEnd(subdivision, tuple(each.name for each in end))


def _last_preserving(modifiers: Sequence[bpy.types.Modifier]) -> tuple[str, ...]:
    """Names of the last modifiers that all leave positions alone."""
    found = [each.name for each in itertools.takewhile(lambda one: one.type in POSITION_PRESERVING, modifiers[::-1])]
    return tuple(found[::-1])


class UnsupportedStackError(InputError):
    """A modifier stack without a list of stages.

    Attributes:
        owner: name of the object; "" if no modifier is the cause.
        modifier: name of the modifier that is the cause.
    """

    def __init__(self, message: str, owner: str = "", modifier: str = "") -> None:
        super().__init__(message)
        self.owner, self.modifier = owner, modifier


def modifier_error(ob: bpy.types.Object, modifier: str, reason: str, other: str = "") -> InputError:
    """The error for a modifier by its name; reason: a key of MODIFIER_REASONS, other: the object that it mentions."""
    text = MODIFIER_REASONS[reason].format(other=other)
    return UnsupportedStackError(f"{ob.name}: {modifier_title(ob.modifiers[modifier])} {text}", ob.name, modifier)


def simulation_error(ob: bpy.types.Object, evaluation: str) -> InputError | None:
    """The error for an object that a modifier simulates in an evaluation; None for other objects."""
    for modifier in ob.modifiers:
        if modifier.type in SIMULATIONS and is_active(modifier, ob, evaluation):
            return modifier_error(ob, modifier.name, "simulated")
    return None


def _stage(ob: bpy.types.Object, modifier: bpy.types.Modifier, scene: bpy.types.Scene, evaluation: str) -> Stage | None:
    if isinstance(modifier, bpy.types.SubsurfModifier):
        return _subdivision(modifier, scene, evaluation)
    if isinstance(modifier, bpy.types.LatticeModifier):
        return _lattice_stage(ob, modifier)
    return None


def _refusal(ob: bpy.types.Object, modifier: bpy.types.Modifier, evaluation: str) -> InputError:
    if is_active(modifier, ob):
        return modifier_error(ob, modifier.name, "unsupported")
    return _refuse_unseen(ob, modifier, evaluation)


def _refuse_unseen(ob: bpy.types.Object, modifier: bpy.types.Modifier, evaluation: str) -> InputError:
    """The error for a modifier that is not shown now; short enough for the status bar."""
    where = "Object Mode" if evaluation == VIEWPORT else "the render"
    title = modifier_title(modifier)
    return UnsupportedStackError(f"{ob.name}: {where} shows {title}; apply it", ob.name, modifier.name)


def _subdivision(
    modifier: bpy.types.SubsurfModifier, scene: bpy.types.Scene, evaluation: str
) -> SubdivisionStage | None:
    levels = subdivision_levels(modifier, scene, evaluation)
    if levels == 0:
        return None
    return SubdivisionStage(
        modifier.name,
        levels,
        modifier.use_limit_surface,
        modifier.quality,
        modifier.subdivision_type == "SIMPLE",
        modifier.boundary_smooth.lower(),
        modifier.use_creases,
    )


def _check_subdivision(ob: bpy.types.Object, stage: SubdivisionStage, before: list[Stage], triangulated: str) -> None:
    if any(isinstance(other, SubdivisionStage) for other in before):
        raise modifier_error(ob, stage.modifier, "second subdivision")
    if triangulated:
        raise modifier_error(ob, triangulated, "before subdivision")


def _lattice_stage(ob: bpy.types.Object, modifier: bpy.types.LatticeModifier) -> LatticeStage | None:
    if modifier.object is None or modifier.strength == 0:
        return None
    group = ob.vertex_groups.get(modifier.vertex_group)
    return LatticeStage(
        modifier.name,
        ObjectReference.of(modifier.object),
        modifier.strength,
        None if group is None else group.index,
        modifier.invert_vertex_group,
    )
