# SPDX-License-Identifier: GPL-3.0-or-later
"""The transform gizmo: Blender's own kinds of handles, which start drags of the extension."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ..operators.transform.start_drag import BLENDER_OPERATORS, constrained_axes, may_collide
from ..scene.frame import read_frame, read_selection
from .handles import HANDLES, Handle, line_range, opacity, placement
from .shown_kinds import shown_kinds

LINE_WIDTH = 2.0
ALPHA = 0.6
CENTRE_SIZE, RING_SIZE, DIAL_SIZE, PLANE_SIZE = 0.2, 6.0, 1.2, 0.7  # those of Blender's gizmo
KEYMAP = "Generic Gizmo Maybe Drag"  # of Blender: a click on a handle still selects what is behind


class STIV_GGT_transform(bpy.types.GizmoGroup):
    """Handles for move, rotate and scale."""

    bl_idname = "STIV_GGT_transform"
    bl_label = "Collision Gizmo"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT", "TOOL_FALLBACK_KEYMAP"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With a tool of the extension, or where the gizmo replaces Blender's."""
        return bool(shown_kinds(context))

    @classmethod
    def setup_keymap(cls, keyconfig: bpy.types.KeyConfig) -> bpy.types.KeyMap:
        """The keys of Blender's own transform gizmos."""
        return keyconfig.keymaps.get(KEYMAP) or keyconfig.keymaps.new(name=KEYMAP)

    def setup(self, context: bpy.types.Context) -> None:
        """Create all handles."""
        self.handles = [(handle, _new_gizmo(self.gizmos, handle)) for handle in HANDLES]
        self.refresh(context)

    def refresh(self, context: bpy.types.Context) -> None:
        """Place the handles: the selection, the pivot, the orientation or the tool may have changed."""
        selection = [] if is_transforming(context) else read_selection(context)
        self.empty = not any(map(len, selection))
        if self.empty:
            return
        frame, kinds, collides = read_frame(context, selection), shown_kinds(context), may_collide(context)
        basis = np.eye(4)
        basis[:3, :3], basis[:3, 3] = frame.axes, frame.pivot
        self.basis = Matrix(basis.tolist())
        for handle, gizmo in self.handles:
            _place(gizmo, handle, kinds, self.basis)
            _set_target(gizmo, handle, collides)

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """Fade and hide handles by the direction of the view."""
        if not self.empty and context.scene.transform_orientation_slots[0].type == "VIEW":
            self.refresh(context)
        if self.empty or is_transforming(context):
            for _, gizmo in self.handles:
                gizmo.hide = True
            return
        kinds, to_view = shown_kinds(context), context.region_data.view_matrix.inverted()
        facing = np.abs(np.array(self.basis.to_3x3()).T @ _view_direction(context, self.basis.translation))
        for handle, gizmo in self.handles:
            visible = opacity(handle, kinds, facing)
            gizmo.hide = visible == 0.0
            gizmo.alpha, gizmo.alpha_highlight = ALPHA * visible, visible
            gizmo.color = gizmo.color_highlight = _colour(context, handle)
            if handle.axis < 0:
                gizmo.matrix_basis = Matrix.Translation(self.basis.translation) @ to_view.to_3x3().to_4x4()


def is_transforming(context: bpy.types.Context) -> bool:
    """Whether a transform runs in the window, with keys or with handles."""
    names = (operator.bl_idname for operator in context.window.modal_operators)
    return any(name == "STIV_OT_drag" or name.startswith("TRANSFORM_OT_") for name in names)


def _new_gizmo(gizmos: bpy.types.Gizmos, handle: Handle) -> bpy.types.Gizmo:
    gizmo = _new_facing(gizmos, handle) if handle.axis < 0 else _new_along(gizmos, handle)
    gizmo.use_draw_offset_scale = handle.axis >= 0
    return gizmo


def _new_facing(gizmos: bpy.types.Gizmos, handle: Handle) -> bpy.types.Gizmo:
    """A handle that faces the view."""
    if handle.kind == "rotate":
        gizmo = gizmos.new("GIZMO_GT_dial_3d")
        gizmo.scale_basis, gizmo.line_width = DIAL_SIZE, LINE_WIDTH
        return gizmo
    gizmo = gizmos.new("GIZMO_GT_primitive_3d")
    gizmo.draw_style = "CIRCLE" if handle.kind == "move" else "ANNULUS"
    gizmo.draw_inner, gizmo.scale_basis, gizmo.line_width = False, CENTRE_SIZE, LINE_WIDTH
    gizmo.select_bias = 2.0 if handle.kind == "move" else -2.0
    if handle.kind == "scale":
        gizmo.arc_inner_factor = RING_SIZE
    return gizmo


def _new_along(gizmos: bpy.types.Gizmos, handle: Handle) -> bpy.types.Gizmo:
    """A handle of an axis or a plane."""
    if handle.kind == "rotate":
        gizmo = gizmos.new("GIZMO_GT_dial_3d")
        gizmo.draw_options, gizmo.line_width = {"CLIP"}, LINE_WIDTH + 1.0
        return gizmo
    gizmo = gizmos.new("GIZMO_GT_arrow_3d")
    if handle.plane:
        gizmo.draw_style, gizmo.draw_options, gizmo.length, gizmo.line_width = "PLANE", set(), PLANE_SIZE, 1.0
    else:
        gizmo.draw_style, gizmo.line_width = "NORMAL" if handle.kind == "move" else "BOX", LINE_WIDTH
    return gizmo


def _place(gizmo: bpy.types.Gizmo, handle: Handle, kinds: frozenset[str], basis: Matrix) -> None:
    if handle.axis < 0:
        return  # follows the view
    gizmo.matrix_basis = basis
    start = 0.0
    if handle.kind != "rotate" and not handle.plane:
        start, end = line_range(handle.kind, kinds)
        gizmo.length = end - start
        gizmo.draw_options = {"STEM"} if handle.kind == "scale" or len(kinds) == 1 else set()
    gizmo.matrix_offset = Matrix(placement(handle, start).tolist())


def _set_target(gizmo: bpy.types.Gizmo, handle: Handle, collides: bool) -> None:
    """Let the handle start a drag, or Blender's own transform if nothing selected has a surface."""
    if collides:
        target = gizmo.target_set_operator("stiv.drag")
        target.kind, target.axis, target.plane, target.release = handle.kind, handle.axis, handle.plane, "LEFTMOUSE"
    else:
        target = gizmo.target_set_operator(f"transform.{BLENDER_OPERATORS[handle.kind]}")
        target.release_confirm = True
        if handle.axis >= 0:
            target.constraint_axis = constrained_axes(handle.axis, handle.plane)


def _view_direction(context: bpy.types.Context, pivot: Matrix) -> np.ndarray:
    """Unit direction between the viewer and the pivot."""
    data = context.region_data
    inverse = data.view_matrix.inverted()
    along = inverse.translation - pivot if data.is_perspective else inverse.col[2].to_3d()
    return np.array(along.normalized())


def _colour(context: bpy.types.Context, handle: Handle) -> tuple[float, ...]:
    theme = context.preferences.themes[0].user_interface
    if handle.axis < 0:
        return tuple(theme.gizmo_view_align)
    return tuple(getattr(theme, f"axis_{'xyz'[handle.axis]}"))


CLASSES = (STIV_GGT_transform,)
