# SPDX-License-Identifier: GPL-3.0-or-later
"""Linked props: those that Blender can move are edited like any other object."""

from pathlib import Path
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv.blender import check_scene  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

CONTACT = 1.5  # of the prop's centre: the wall's face is at 2, the prop is 1 wide


@pytest.fixture
def linked_set(tmp_path: Path) -> Any:
    """A collection of one prop, linked from another file into a scene with a wall."""
    library = str(tmp_path / "props ü.blend")
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.name = "Prop"
    props = bpy.data.collections.new("Set")
    props.objects.link(bpy.context.object)
    bpy.data.libraries.write(library, {props})
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 0), scale=(1, 4, 4))
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.collections = ["Set"]
    (linked,) = wanted.collections
    bpy.context.scene.collection.children.link(linked)
    return linked


def overridden(linked: Any, editable: bool) -> Any:
    """The prop as a library override, the only selected object."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    props = linked.override_hierarchy_create(scene, view_layer, do_fully_editable=editable)
    if linked.name in scene.collection.children:
        scene.collection.children.unlink(linked)
    (prop,) = props.objects
    only(prop)
    return prop


def only(ob: Any) -> None:
    bpy.context.view_layer.update()
    for other in bpy.context.view_layer.objects:
        other.select_set(other == ob)
    bpy.context.view_layer.objects.active = ob


def in_saved_file(path: Path) -> Any:
    """The prop after saving and loading."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return next(ob for ob in bpy.context.scene.objects if ob.name == "Prop" and ob.override_library is not None)


def test_an_override_stops_at_the_wall_and_the_file_keeps_it(linked_set: Any, tmp_path: Path) -> None:
    overridden(linked_set, editable=True)
    assert bpy.ops.stiv.rotate(angle=0.0) == {"FINISHED"}
    assert bpy.ops.stiv.move(value=(4, 0, 0)) == {"FINISHED"}
    prop = in_saved_file(tmp_path / "dressed.blend")
    assert CONTACT - 0.02 < prop.location.x < CONTACT
    assert check_scene(bpy.context).pairs == ()
    only(prop)
    assert bpy.ops.stiv.scale(value=(1, 2, 1)) == {"FINISHED"}
    assert in_saved_file(tmp_path / "dressed.blend").scale.y == pytest.approx(2.0)


def test_an_instance_of_a_linked_collection_stops_at_the_wall(linked_set: Any) -> None:
    bpy.context.scene.collection.children.unlink(linked_set)
    shown = bpy.data.objects.new("Shown", None)
    shown.instance_type, shown.instance_collection = "COLLECTION", linked_set
    bpy.context.collection.objects.link(shown)
    only(shown)
    assert bpy.ops.stiv.move(value=(4, 0, 0)) == {"FINISHED"}
    assert CONTACT - 0.02 < shown.location.x < CONTACT
    assert tuple(linked_set.objects[0].location) == (0.0, 0.0, 0.0)


def test_an_override_yields_to_an_object_pushed_into_it(linked_set: Any) -> None:
    overridden(linked_set, editable=True).location.x = 0.5
    only(next(ob for ob in bpy.context.scene.objects if ob.name != "Prop"))
    bpy.context.scene.stiv.responders = "unselected"
    try:
        assert bpy.ops.stiv.move(value=(-1, 0, 0)) == {"FINISHED"}
    finally:
        bpy.context.scene.stiv.responders = "selected"
    (prop,) = (ob for ob in bpy.context.scene.objects if ob.name == "Prop")
    assert prop.location.x < 0.5 + 1e-6 and check_scene(bpy.context).pairs == ()
    assert bpy.context.object.location.x == pytest.approx(1.5)


def test_an_object_that_blender_does_not_let_move_is_rejected_by_name(linked_set: Any) -> None:
    (prop,) = linked_set.objects
    only(prop)
    with pytest.raises(RuntimeError, match="Prop: it is linked; make a library override of it"):
        bpy.ops.stiv.move(value=(4, 0, 0))
    prop = overridden(linked_set, editable=False)
    with pytest.raises(RuntimeError, match="Prop: its override is not editable; make it editable in the Out"):
        bpy.ops.stiv.move(value=(4, 0, 0))
    assert tuple(prop.location) == (0.0, 0.0, 0.0)
    prop.override_library.is_system_override = False
    assert bpy.ops.stiv.move(value=(4, 0, 0)) == {"FINISHED"}
    assert prop.location.x == pytest.approx(CONTACT, abs=0.02)


def test_the_role_of_an_override_can_be_chosen_and_the_file_keeps_it(linked_set: Any, tmp_path: Path) -> None:
    prop = overridden(linked_set, editable=True)
    assert prop.is_property_overridable_library("stiv")
    prop.stiv.role = "obstacle"
    assert in_saved_file(tmp_path / "roles.blend").stiv.role == "obstacle"
