# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds data-blocks that may depend on others without a reference to them, such as simulations and scripts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy

from stiv.blender.scene.dependencies import has_node
from stiv.blender.scene.evaluations import is_edited

SIMULATIONS = frozenset({"CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT", "EXPLODE"})  # modifiers
TRACKING = frozenset({"FOLLOW_TRACK", "OBJECT_SOLVER", "CAMERA_SOLVER"})  # constraints that may use the scene's camera
NODES = ("GeometryNodeSimulationInput", "GeometryNodeInputActiveCamera")


def find_unpredictable(data: Iterable[bpy.types.ID]) -> Iterator[bpy.types.ID]:
    """Those of some data-blocks that other data may change without a reference between them."""
    for each in data:
        if _has_script(each) or (isinstance(each, bpy.types.Object) and _is_unpredictable(each)):
            yield each


def _is_unpredictable(ob: bpy.types.Object) -> bool:
    """May other objects, a mode or a simulation change the object? Metaballs of one name change each other."""
    if ob.type == "META" or ob.mode != "OBJECT" or is_edited(ob):
        return True
    bones = () if ob.pose is None else ob.pose.bones
    return (
        any(map(_is_simulated, ob.modifiers))
        or any(map(_has_instances, ob.particle_systems))
        or any(each.type in TRACKING for owner in (ob, *bones) for each in owner.constraints)
    )


def _is_simulated(modifier: bpy.types.Modifier) -> bool:
    if isinstance(modifier, bpy.types.NodesModifier):
        return any(has_node(modifier.node_group, kind) for kind in NODES)
    return modifier.type in SIMULATIONS


def _has_instances(particles: bpy.types.ParticleSystem) -> bool:
    """Force fields and colliders move particles, and hair, which may show instances."""
    settings = particles.settings
    return settings.type != "HAIR" or settings.render_type in ("OBJECT", "COLLECTION")


def _has_script(data: bpy.types.ID) -> bool:
    """Has a data-block, or its nodes, a driver that can read any data?"""
    owners = (data, getattr(data, "node_tree", None))
    animations = (getattr(owner, "animation_data", None) for owner in owners)
    return any(_is_script(curve.driver) for each in animations if each is not None for curve in each.drivers)


def _is_script(driver: bpy.types.Driver) -> bool:
    """Does the driver run Python, or read what depends on the context?"""
    is_python = driver.type == "SCRIPTED" and not driver.is_simple_expression
    return is_python or any(variable.type == "CONTEXT_PROP" for variable in driver.variables)
