# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.place`: spreads copies of the active object on a surface."""

from __future__ import annotations

from math import pi

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from ... import stiv_blender
from .layout_operator import LayoutOperator


class STIV_OT_place(LayoutOperator, bpy.types.Operator):
    """Spread copies of the active object on the selected surfaces"""

    bl_idname = "stiv.place"
    bl_label = "Place"

    count: IntProperty(name="Count", description="Number of copies", default=10, min=1, soft_max=200, max=10000)
    seed: IntProperty(name="Seed", description="Seed of the random places", default=0, min=0)
    align: BoolProperty(
        name="Align to Normal", description="Turn the local Z axis of copies to the normal of the surface", default=True
    )
    scale_variation: FloatProperty(
        name="Scale Variation",
        description="Scale each copy by a random factor that differs from 1 by up to this",
        subtype="FACTOR",
        default=0.0,
        min=0.0,
        max=0.9,
    )
    rotation_variation: FloatProperty(
        name="Rotation Variation",
        description="Turn each copy about its normal by a random angle up to this, either way",
        subtype="ANGLE",
        default=pi,
        min=0.0,
        max=pi,
    )
    linked: BoolProperty(name="Linked", description="Let copies share the data of the object", default=True)
    surface: StringProperty(
        name="Surface", description="Object to place on; the other selected objects if empty", options={"SKIP_SAVE"}
    )

    def prepare(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Choose the object under the pointer if nothing else is selected."""
        if self.surface or any(ob != context.active_object for ob in context.selected_objects):
            return
        if context.region_data is not None and context.region.type == "WINDOW":
            self.surface = _object_at(context, (event.mouse_region_x, event.mouse_region_y))

    def begin(self, context: bpy.types.Context) -> stiv_blender.Place:
        """Read the scene."""
        values = (self.align, self.scale_variation, self.rotation_variation, self.linked)
        edit = self.settings(context)
        settings = stiv_blender.PlaceSettings(edit, self.surface, self.count, self.seed, *values)
        return stiv_blender.Place(context, settings)


def _object_at(context: bpy.types.Context, pixel: tuple[int, int]) -> str:
    """The name of the object under a pixel of the region, other than the active one; "" if there is none."""
    origin = region_2d_to_origin_3d(context.region, context.region_data, pixel)
    direction = region_2d_to_vector_3d(context.region, context.region_data, pixel)
    hit, _, _, _, found, _ = context.scene.ray_cast(context.evaluated_depsgraph_get(), origin, direction)
    return found.name if hit and found.name != context.active_object.name else ""
