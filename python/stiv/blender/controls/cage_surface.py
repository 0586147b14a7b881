# SPDX-License-Identifier: GPL-3.0-or-later
"""How the evaluated surfaces of a mesh follow its cage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy

import stiv
from stiv.blender.controls.affine_images import uniform_factor
from stiv.blender.controls.control_set import ShownAs, Writer
from stiv.blender.controls.editable import shared_data_error
from stiv.blender.controls.observed_stack import ObservedStack, ShownStack
from stiv.blender.controls.shared_meshes import in_frames
from stiv.blender.controls.subdivision import identity_deformation, stack_deformations, subdivide
from stiv.blender.scene.arrays import Floats, as_matrix, invert, transform_points
from stiv.blender.scene.evaluations import SHOWN, is_active, is_edited
from stiv.blender.scene.lattice_reading import is_undeformed
from stiv.blender.scene.modifier_stack import (
    LatticeStage,
    SubdivisionStage,
    UnsupportedStackError,
    modifier_error,
    read_stack,
)
from stiv.task import Steps

if TYPE_CHECKING:
    from stiv.blender.controls.cage import CageWriter


@dataclass(frozen=True)
class CageSurface:
    """All surfaces that show a mesh, stacked.

    Attributes:
        deformation: from the cage; None for the identity.
        observed: the stacks that Blender evaluates during the edit; None if all modifiers are known.
    """

    deformation: stiv.Deformation | None
    observed: ObservedStack | None = None

    def of_vertices(self, vertices: stiv.Deformation) -> stiv.Deformation:
        """The surfaces of controls that move the vertices of the cage by a deformation."""
        if self.observed is not None:
            return self.observed.deformation_of(vertices)
        return vertices if self.deformation is None else stiv.compose(self.deformation, vertices)

    def limited(self, writer: CageWriter) -> Writer:
        """A writer that keeps vertices where Mirror and Weld modifiers need them."""
        return writer if self.observed is None else HoldingWriter(writer, self.observed)


@dataclass(frozen=True)
class HoldingWriter:
    """Writes a cage whose vertices are held by its modifiers."""

    writer: CageWriter
    observed: ObservedStack

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3)."""
        self.writer.write(self.observed.hold(controls))

    def restore(self) -> None:
        """Write the original positions."""
        self.writer.restore()


def read_surface_steps(
    ob: bpy.types.Object, scene: bpy.types.Scene, writer: CageWriter, shown: Sequence[ShownAs]
) -> Steps[CageSurface]:
    """Steps that read how all surfaces that show a mesh follow its cage.

    Raise InputError for modifiers that no edit can follow.
    """
    users = [bpy.data.objects[each.owner] for each in shown] if len(shown) > 1 else [ob]
    users = [user if user.data == ob.data else ob for user in users]  # another mesh shows a Loop subdivision
    rows = list(zip(users, [each.evaluation for each in shown] or [SHOWN], strict=True))
    try:
        return CageSurface(_known_surfaces(ob, scene, writer, rows))
    except UnsupportedStackError:
        showings = [ShownStack(user, each, _keys(user, writer, each)) for user, each in rows]
        controls = transform_points(writer.frame, writer.original)
        observed = yield from ObservedStack.read_steps(scene, writer.frame, controls, showings)
        return CageSurface(observed.deformation, observed)


def hidden_note(ob: bpy.types.Object, shown: Sequence[ShownAs]) -> str:
    """Message about the modifiers that an edit follows though Edit Mode does not show them; "" if there are none."""
    if not is_edited(ob):
        return ""
    evaluations = {each.evaluation for each in shown}
    hidden = [
        modifier.name for modifier in ob.modifiers
        if not is_active(modifier, ob) and any(is_active(modifier, ob, each) for each in evaluations)
    ]  # fmt: skip
    names = ", ".join(hidden)
    return f'{ob.name}: also follows "{names}", hidden in Edit Mode' if hidden else ""


def _known_surfaces(
    ob: bpy.types.Object, scene: bpy.types.Scene, writer: CageWriter, rows: Sequence[tuple[bpy.types.Object, str]]
) -> stiv.Deformation | None:
    """Deformation by known modifiers, of one object or of several whose transforms differ by location and size.

    None for the identity. Raises UnsupportedStackError for others.
    """
    inverse = invert(writer.frame)
    maps = [as_matrix(user.matrix_world) @ inverse for user, _ in rows]
    turned = [user for (user, _), each in zip(rows, maps, strict=True) if user != ob and uniform_factor(each) is None]
    if turned:
        raise UnsupportedStackError(str(shared_data_error(ob, turned[0])))
    found = [_known_surface(user, scene, _seen_from(writer, user, ob), each) for user, each in rows]
    if len(found) == 1:
        return found[0]
    count = len(writer.original)
    if all(user == ob for user, _ in rows):
        return stack_deformations([identity_deformation(count) if each is None else each for each in found])
    return in_frames(found, maps, count)


def _seen_from(writer: CageWriter, user: bpy.types.Object, ob: bpy.types.Object) -> CageWriter:
    return writer if user == ob else replace(writer, frame=as_matrix(user.matrix_world))


def _known_surface(
    ob: bpy.types.Object, scene: bpy.types.Scene, writer: CageWriter, evaluation: str
) -> stiv.Deformation | None:
    """Deformation from the cage to its mesh: Loop subdivision, that of its modifiers, or None for no subdivision.

    Raises UnsupportedStackError for unknown modifiers.
    """
    cage = _keys(ob, writer, evaluation)
    if writer.refined is not None:
        return _of_cage(writer.refined.refinement.deformation, cage)
    result = None
    for stage in read_stack(ob, scene, evaluation):
        if isinstance(stage, LatticeStage) and not is_undeformed(stage.lattice.find().data):
            raise modifier_error(ob, stage.modifier, "deformed lattice", stage.lattice.name)
        if isinstance(stage, SubdivisionStage):
            result = subdivide(ob.data, stage)
    return _of_cage(result, cage)


def _keys(ob: bpy.types.Object, writer: CageWriter, evaluation: str) -> stiv.Deformation | None:
    return None if writer.keys is None else writer.keys.deformation(ob, writer.frame, evaluation)


def _of_cage(subdivision: stiv.Deformation | None, cage: stiv.Deformation | None) -> stiv.Deformation | None:
    """The subdivision of a cage that follows the controls; None for the identity, each."""
    return subdivision if cage is None else cage if subdivision is None else stiv.compose(subdivision, cage)
