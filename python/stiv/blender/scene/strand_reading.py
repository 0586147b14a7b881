# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads strands: curves without surface, hair curves and particle hair."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.arrays import Floats, as_matrix, read_collection
from stiv.blender.scene.dependencies import referenced_objects
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_edges, read_positions
from stiv.blender.scene.strands import SUBDIVISION, Strands, edge_strands, hair_strands, join_strands, polyline_strands

STRAND_TYPES = ("CURVE", "CURVES")
MAX_SEGMENTS = 50_000  # of one object; 600,000 triangles, which every increment of an edit examines
MISSING_RADIUS = 0.01  # Blender's default for hair curves without the attribute
CATMULL_ROM, POLY = 0, 1  # values of the attribute curve_type


def why_no_strands(shown: bpy.types.Object, owner: bpy.types.Object, helpers: frozenset[str]) -> str:
    """Why an object of STRAND_TYPES is not an obstacle; "" if it is."""
    if shown.type == "CURVE":
        return "helper curves" if owner.name in helpers else _too_many("curves without surface", _size(shown.data))
    curves = shown.data
    types = _values(curves, "curve_type", np.int8, len(curves.curves), CATMULL_ROM)
    if not np.isin(types, (CATMULL_ROM, POLY)).all():
        return "hair curves of type Bézier or NURBS"
    segments = (len(curves.points) - len(curves.curves)) * (SUBDIVISION if (types == CATMULL_ROM).any() else 1)
    return _too_many("hair curves", segments)


def read_strands(instance: bpy.types.DepsgraphObjectInstance) -> Strands:
    """Strands of an instance of STRAND_TYPES, in the world."""
    shown, matrix = instance.object, as_matrix(instance.matrix_world)
    return (_read_curve(shown) if shown.type == "CURVE" else _read_hair_curves(shown.data)).moved(matrix)


def hair_systems(ob: bpy.types.Object) -> list[int]:
    """Indices of the particle systems that the viewport shows as strands."""
    names = [
        modifier.particle_system.name for modifier in ob.modifiers
        if isinstance(modifier, bpy.types.ParticleSystemModifier) and modifier.show_viewport
        and modifier.particle_system.settings.type == "HAIR"
        and modifier.particle_system.settings.render_type == "PATH"
    ]  # fmt: skip
    return [index for index, system in enumerate(ob.particle_systems) if system.name in names]


def why_no_particle_hair(evaluated: bpy.types.Object) -> str:
    """Why the particle hair of an evaluated object is not an obstacle; "" if it is."""
    systems = (evaluated.particle_systems[index] for index in hair_systems(evaluated))
    return _too_many("particle hair", sum(len(_shown_strands(each)) * _steps(each.settings) for each in systems))


def read_particle_hair(evaluated: bpy.types.Object) -> Strands:
    """Particle hair of an evaluated object as the viewport shows it, in the world."""
    scale = float(np.linalg.norm(as_matrix(evaluated.matrix_world)[:3, :3], 2))
    found: list[Strands] = []
    first = 0
    for index in hair_systems(evaluated):
        system = evaluated.particle_systems[index]
        settings, shown = system.settings, _shown_strands(system)
        steps = range(_steps(settings) + 1)
        points = [system.co_hair(evaluated, particle_no=number, step=step) for number in shown for step in steps]
        radius = 0.5 * settings.radius_scale * max(settings.root_radius, settings.tip_radius) * scale
        strands = polyline_strands(
            np.array(points, np.float64).reshape(-1, 3),
            np.full(len(shown), len(steps), np.int32),
            np.full(len(points), radius),
        )
        found.append(Strands(strands.ends, strands.radii, strands.numbers + np.int32(first)))
        first += len(shown)
    return join_strands(found)


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """The object to which hair curves are attached, or None."""
    return ob.data.surface if isinstance(ob.data, bpy.types.Curves) else None


def helper_curves(context: bpy.types.Context) -> frozenset[str]:
    """Names of the curves that only shape, guide or carry other objects."""
    return frozenset(
        used.name for ob in context.scene.objects for used in _used_by(ob) if used is not None and used.type == "CURVE"
    )


def check_finite(strands: Strands, name: str) -> None:
    """Raise InputError naming object and strand if a coordinate or radius is not finite."""
    finite = np.isfinite(strands.ends).all(axis=(1, 2)) & np.isfinite(strands.radii)
    if not finite.all():
        number = int(strands.numbers[int(np.argmin(finite))])
        raise InputError(f"{name}: strand {number} has a value that is not finite; delete it")


def _too_many(what: str, segments: int) -> str:
    return f"{what} of more than {MAX_SEGMENTS:,} segments" if segments > MAX_SEGMENTS else ""


def _size(curve: bpy.types.Curve) -> int:
    return sum((len(each.points) + len(each.bezier_points)) * each.resolution_u for each in curve.splines)


def _read_curve(shown: bpy.types.Object) -> Strands:
    with evaluated_mesh(shown) as mesh:
        if mesh is None:  # a curve without points
            return join_strands([])
        return edge_strands(read_positions(mesh).astype(np.float64), read_edges(mesh))


def _read_hair_curves(curves: Any) -> Strands:
    count = len(curves.curves)
    if count == 0:
        return join_strands([])
    counts = np.diff(read_collection(curves.curve_offset_data, "value", 1, np.int32))
    points: Floats = read_collection(curves.attributes["position"].data, "vector", 3, np.float32).astype(np.float64)
    radii = np.maximum(_values(curves, "radius", np.float32, len(points), MISSING_RADIUS).astype(np.float64), 0.0)
    smooth = _values(curves, "curve_type", np.int8, count, CATMULL_ROM) == CATMULL_ROM
    return hair_strands(points, counts, radii, smooth, _values(curves, "cyclic", np.bool_, count, False))


def _values(curves: Any, name: str, dtype: type, count: int, missing: Any) -> Any:
    """An attribute of hair curves, or Blender's default if there is none."""
    attribute = curves.attributes.get(name)
    if attribute is None or len(attribute.data) != count:
        return np.full(count, missing, dtype)
    return read_collection(attribute.data, "value", 1, dtype)


def _shown_strands(system: Any) -> range:
    """Numbers of the visible strands, parents first."""
    parents, children = len(system.particles), len(system.child_particles)
    if system.settings.child_type == "NONE" or children == 0:
        return range(parents)
    return range(0 if system.settings.use_parent_particles else parents, parents + children)


def _steps(settings: Any) -> int:
    extra = settings.kink_extra_steps if settings.kink == "SPIRAL" else 0
    return int(2**settings.display_step + extra)


def _used_by(ob: bpy.types.Object) -> Iterator[Any]:
    """Objects that determine the shape or the path of an object."""
    for modifier in ob.modifiers:
        yield from (used for used in referenced_objects(modifier) if used != ob)
    bones = ob.pose.bones if ob.pose is not None else ()
    for constraint in (*ob.constraints, *(each for bone in bones for each in bone.constraints)):
        yield from referenced_objects(constraint)
    yield from (bone.custom_shape for bone in bones)
    if ob.parent is not None and ob.parent.type == "CURVE" and ob.parent.data.use_path:
        yield ob.parent
    if isinstance(ob.data, bpy.types.Curve):
        yield from (ob.data.bevel_object, ob.data.taper_object)
