# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes whose objects depend on each other, against Blender in Object Mode and as rendered.

Each object depends on earlier ones alone, so that there are no cycles.
"""

import random
from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_lattice, as_rendered, evaluated, select
from evaluation_reading import read_both
from mathutils import Matrix, Vector

SCENES, SEEDS = 6, 12  # in each: 72 scenes take four seconds
DIFFERING = (
    ("SUBSURF", {"levels": 0, "render_levels": 1}),
    ("DISPLACE", {"strength": 0.3, "mid_level": 0.0}),
    ("SMOOTH", {"factor": 0.7}),
    ("SIMPLE_DEFORM", {"angle": 0.5}),
)
CONSTRAINTS = ("COPY_LOCATION", "COPY_TRANSFORMS", "CHILD_OF", "TRACK_TO", "SHRINKWRAP")
REFERRING = {"HOOK": "object", "MIRROR": "mirror_object", "SHRINKWRAP": "target", "BOOLEAN": "object", "CAST": "object"}


def vector(size: float = 1.0) -> tuple[float, ...]:
    return tuple(random.uniform(-size, size) for _ in range(3))


def matrix() -> Matrix:
    return Matrix.Translation(vector(2)) @ Matrix.Rotation(random.uniform(-2, 2), 4, Vector((*vector()[:2], 1)))


def add_rig() -> Any:
    rig = add("Rig", bpy.data.armatures.new("Rig"), vector(3))
    select(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Bone").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["Bone"].location = vector()
    return rig


def add_modifiers(ob: Any, meshes: Sequence[Any], lattices: Sequence[Any]) -> None:
    """Modifiers that the viewport and the render may show differently, and those that refer to earlier objects."""
    for kind, values in random.sample(DIFFERING, random.randint(0, 2)):
        modifier = ob.modifiers.new(kind, kind)
        for name, value in values.items():
            setattr(modifier, name, value)
        modifier.show_viewport, modifier.show_render = random.choice([(True, False), (False, True), (True, True)])
    for kind in random.sample(sorted(REFERRING), random.randint(0, 1)) if meshes else ():
        modifier = ob.modifiers.new(kind, kind)
        setattr(modifier, REFERRING[kind], random.choice(meshes))
        if kind == "HOOK":
            modifier.vertex_indices_set((0, 1, 2))
            modifier.matrix_inverse = matrix()
    if lattices and random.random() < 0.3:
        ob.modifiers.new("Lattice", "LATTICE").object = random.choice(lattices)


def add_relations(ob: Any, before: Sequence[Any]) -> None:
    """A parent of any kind with an inverse, and a constraint."""
    if random.random() < 0.6:
        ob.parent = random.choice(before)
        if ob.parent.type == "ARMATURE":
            ob.parent_type, ob.parent_bone = "BONE", "Bone"
        elif ob.parent.type == "MESH" and random.random() < 0.4:
            ob.parent_type, ob.parent_vertices = "VERTEX", (3, 0, 0)
        ob.matrix_parent_inverse = matrix()
    targets = [each for each in before if each.type == "MESH"]
    if targets and random.random() < 0.4:
        constraint = ob.constraints.new(random.choice(CONSTRAINTS))
        constraint.target, constraint.influence = random.choice(targets), 0.7
        if constraint.type == "CHILD_OF":
            constraint.inverse_matrix = matrix()


def build(seed: int) -> list[Any]:
    """The meshes of a random scene."""
    random.seed(seed)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    lattice = add_lattice("Lattice", (2, 2, 2), vector(2), scale=(3, 3, 3))
    lattice.data.points[0].co_deform = (-1.0, -0.2, -0.1)
    objects = [add_cube(name, vector(4)) for name in "ABCDE"] + [add_rig(), lattice, add("Empty", None, vector(3))]
    random.shuffle(objects)
    for number, ob in enumerate(objects):
        before = objects[:number]
        if ob.type == "MESH":
            add_modifiers(
                ob, [each for each in before if each.type == "MESH"], [each for each in before if each == lattice]
            )
        if before:
            add_relations(ob, before)
    meshes = [ob for ob in objects if ob.type == "MESH"]
    random.choice(meshes).hide_render = random.random() < 0.5
    bpy.context.view_layer.update()
    return meshes


def check(found: dict[str, np.ndarray], meshes: Sequence[Any], what: str) -> None:
    for ob in meshes:
        wanted = evaluated(ob)
        if ob.visible_get() and len(wanted):
            tolerance = 1e-5 * (1 + np.abs(wanted).max())
            np.testing.assert_allclose(found[ob.name], wanted, rtol=0, atol=tolerance, err_msg=f"{what}, {ob.name}")


@pytest.mark.parametrize("first", range(0, SCENES * SEEDS, SEEDS))
def test_what_objects_depend_on_is_evaluated_as_shown_and_as_rendered(first: int) -> None:
    for seed in range(first, first + SEEDS):
        meshes = build(seed)
        viewport, render = read_both(*random.choice([[], *([each] for each in meshes)]))
        check(viewport, meshes, f"seed {seed}, viewport")
        as_rendered()
        check(render, meshes, f"seed {seed}, render")
