# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of objects that show the same data, each against Blender's own evaluation of that object."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_modifier, edit_mode, evaluated
from numpy.testing import assert_array_equal

from stiv.blender.scene import deferred_meshes
from stiv.blender.scene.deferred_meshes import SELF_CONTAINED, EqualMeshes, compute_meshes_steps
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.static_reading import forget_static_meshes, read_static_meshes
from stiv.task import run


def linked(*kinds: str, count: int = 2) -> list[Any]:
    """Objects in a row that show one monkey through stacks of these modifiers."""
    bpy.ops.mesh.primitive_monkey_add()
    data = bpy.context.object.data
    data.materials.append(None)
    bpy.data.objects.remove(bpy.context.object)
    objects = [add(f"Suzanne {number}", data, (4 * number, 0, 0)) for number in range(count)]
    for ob in objects:
        for kind in kinds:
            add_modifier(ob, kind)
    return objects


def representatives(objects: list[Any]) -> set[str]:
    graph = bpy.context.evaluated_depsgraph_get()
    equal = EqualMeshes(graph)
    return {equal.representative(each.evaluated_get(graph)).name for each in objects}


def check_against_blender(objects: list[Any]) -> None:
    """Both ways to read give each object the positions that Blender evaluates for it."""
    forget_static_meshes()
    read = {each.owner.name: each for each in read_scene(bpy.context).meshes}
    names = {each.name for each in objects}
    static = {each.owner.name: each for each in read_static_meshes(bpy.context, names, frozenset({SHOWN}))}
    assert read.keys() == static.keys() == names
    for ob in objects:
        expected = evaluated(ob)
        assert np.abs(read[ob.name].world() - expected).max() < 1e-5
        assert_array_equal(static[ob.name].obstacle.vertices, read[ob.name].world())


def changed(modifier: Any, random: np.random.Generator) -> bool:
    """Give a random setting of a modifier another value. Without one that changes, returns False."""
    chosen = [each for each in modifier.bl_rna.properties if not each.is_readonly and each.identifier != "name"]
    prop = chosen[random.integers(len(chosen))]
    before = getattr(modifier, prop.identifier)
    values: dict[str, Callable[[], Any]] = {
        "BOOLEAN": lambda: not before,
        "INT": lambda: before + 1,
        "FLOAT": lambda: before + 0.05,
        "ENUM": lambda: random.choice([each.identifier for each in prop.enum_items]),
    }
    if prop.type not in values or getattr(prop, "is_array", False) or getattr(prop, "is_enum_flag", False):
        return False
    try:
        setattr(modifier, prop.identifier, values[prop.type]())
    except TypeError:  # a value that this version does not offer
        return False
    return bool(getattr(modifier, prop.identifier) != before)


@pytest.mark.parametrize("kind", sorted(SELF_CONTAINED))
def test_objects_with_different_settings_are_read_as_blender_shows_them(kind: str) -> None:
    random = np.random.default_rng(len(kind))
    objects = linked(kind, "SUBSURF", count=8)
    different = sum(changed(ob.modifiers[0], random) for ob in objects[2:])
    assert different > 0
    check_against_blender(objects)
    assert representatives(objects[:2]) == {"Suzanne 0"}
    assert len(representatives(objects)) > 1


def test_equal_stacks_are_computed_once() -> None:
    objects = linked("MIRROR", "SUBSURF", count=5)
    objects[3].modifiers[1].name = "Other"
    assert representatives(objects) == {"Suzanne 0"}
    text = bpy.data.curves.new("Text", "FONT")
    text.body = "ab"
    add_modifier(add("Text", text, (0, 9, 0)), "SUBSURF")
    run(compute_meshes_steps(bpy.context))
    bpy.data.objects.remove(bpy.data.objects["Text"])
    check_against_blender(objects)


def test_steps_compute_each_different_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    """Afterwards, nothing remains to be computed: reading takes no further modifier evaluation."""
    objects = linked("SUBSURF", count=4)
    objects[2].modifiers[0].levels = 2
    found = []
    monkeypatch.setattr(deferred_meshes, "len", lambda polygons: found.append(len(polygons)), raising=False)
    references = [ObjectReference.of(ob) for ob in objects]
    monkeypatch.setattr(deferred_meshes, "_visible_meshes", lambda context: references)
    run(compute_meshes_steps(bpy.context))
    assert found == [len(evaluated_faces(objects[0])), len(evaluated_faces(objects[2]))]


def evaluated_faces(ob: Any) -> Any:
    return ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.polygons


def mirrored_about_another(ob: Any) -> None:
    ob.modifiers[0].mirror_object = add("Center", None, (1, 0, 0))


def deformed(ob: Any) -> None:
    add_modifier(ob, "CAST")


def bevelled_by_a_profile(ob: Any) -> None:
    add_modifier(ob, "BEVEL", profile_type="CUSTOM")


def with_other_data(ob: Any) -> None:
    ob.data = ob.data.copy()


@pytest.mark.parametrize("change", [mirrored_about_another, deformed, bevelled_by_a_profile, with_other_data])
def test_a_mesh_that_may_differ_is_not_shared(change: Callable[[Any], None]) -> None:
    objects = linked("MIRROR", "SUBSURF", count=3)
    change(objects[1])
    bpy.context.view_layer.update()
    assert representatives(objects) == {"Suzanne 0", "Suzanne 1"}
    check_against_blender(objects)


def test_a_shown_shape_key_is_not_shared() -> None:
    objects = linked("SUBSURF", count=2)
    objects[0].shape_key_add(name="Basis")
    objects[0].shape_key_add(name="Wide").data[0].co.x += 1
    objects[1].show_only_shape_key, objects[1].active_shape_key_index = True, 1
    bpy.context.view_layer.update()
    assert len(representatives(objects)) == 2
    check_against_blender(objects)


def test_edited_meshes_are_not_shared() -> None:
    objects = linked("SUBSURF", count=2)
    objects[0].modifiers[0].show_in_editmode = False
    edit_mode(objects[0])
    assert len(representatives(objects)) == 2


def test_instances_show_the_mesh_of_their_source() -> None:
    """An evaluated object of an instance ends with the next instance; nothing may keep it."""
    first, second = linked("SUBSURF", count=2)
    second.modifiers[0].levels = 2
    group = bpy.data.collections.new("Group")
    for ob in (first, second):
        bpy.context.collection.objects.unlink(ob)
        group.objects.link(ob)
    for number in range(3):
        add(f"Instancer {number}", None, (0, 5 * number, 0), instance_type="COLLECTION", instance_collection=group)
    bpy.context.view_layer.update()
    read = list(read_scene(bpy.context).meshes)
    assert sorted({(each.owner.name, each.source) for each in read}) == sorted(
        (f"Instancer {number}", ob.name) for number in range(3) for ob in (first, second)
    )
    expected = {ob.name: (evaluated(ob), np.array(ob.matrix_world)) for ob in (first, second)}
    for each in read:
        points, own = expected[each.source]
        placed = each.matrix @ np.linalg.inv(own)
        assert np.abs(each.world() - (points @ placed[:3, :3].T + placed[:3, 3])).max() < 1e-5
