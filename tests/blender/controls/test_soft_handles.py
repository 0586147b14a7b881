# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes moved by handles: Blender shows the written state, anchors stay exactly, nothing intersects."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import (
    add,
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    edit_mode,
    evaluated,
    mesh,
    moved,
    select,
    shift,
    snapshot,
    turn,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, Handles, WeightGroup, check_scene

KINDS = ("laplacian", "arap")


def tube(name: str = "Tube", rings: int = 12, around: int = 8, **properties: Any) -> Any:
    """An open tube along z from 0 to 3 of radius 0.4, with the groups "Top" and "Foot" at its ends."""
    angles = np.linspace(0, 2 * np.pi, around, endpoint=False)
    rows = [(0.4 * np.cos(a), 0.4 * np.sin(a), 3.0 * ring / (rings - 1)) for ring in range(rings) for a in angles]
    faces = [
        (r * around + k, r * around + (k + 1) % around, (r + 1) * around + (k + 1) % around, (r + 1) * around + k)
        for r in range(rings - 1)
        for k in range(around)
    ]
    ob = add(name, mesh(name, rows, faces), **properties)
    group(ob, "Top", range((rings - 1) * around, rings * around))
    group(ob, "Foot", range(around))
    return ob


def group(ob: Any, name: str, vertices: Any, weight: float = 1.0) -> None:
    made = ob.vertex_groups.get(name) or ob.vertex_groups.new(name=name)
    made.add([int(vertex) for vertex in vertices], weight, "REPLACE")


def settings_of(kind: str, **handles: Any) -> EditSettings:
    chosen = Handles(**({"groups": ("Top",), "anchor": "Foot"} | handles))
    return EditSettings(deformations={"Tube": kind}, handles={"Tube": chosen})


def begin(settings: EditSettings, kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, kind)


def members(ob: Any, name: str) -> np.ndarray:
    number = ob.vertex_groups[name].index
    return np.array([v.index for v in ob.data.vertices if any(g.group == number for g in v.groups)])


def local(ob: Any) -> np.ndarray:
    return np.array([tuple(v.co) for v in ob.data.vertices], np.float32)


@pytest.mark.parametrize("subdivided", [False, True], ids=["mesh", "cage"])
@pytest.mark.parametrize("kind", KINDS)
def test_handles_reach_their_goal_and_the_other_vertices_follow(kind: str, subdivided: bool) -> None:
    ob = tube(location=(0.3, 0, 0.1), rotation_euler=(0.2, 0, 0.4), scale=(1.2, 1.2, 1.2))
    if subdivided:
        add_modifier(ob, "SUBSURF", levels=1, render_levels=1)
    select(ob)
    start, before = snapshot(), local(ob)
    edit = begin(settings_of(kind))
    assert {each.role for each in edit.summary.participants} == {"soft"}
    assert snapshot() == start
    assert edit.apply(shift(0.5, 0, 0.3)).status == "reached"
    assert edit.write().passed
    world = np.array(ob.matrix_world, float)
    top, foot = members(ob, "Top"), members(ob, "Foot")
    assert moved(world, local(ob)[top]) == pytest.approx(moved(shift(0.5, 0, 0.3) @ world, before[top]), abs=1e-6)
    assert (local(ob)[foot] == before[foot]).all()
    middle = np.setdiff1d(np.arange(len(before)), [*top, *foot])
    assert (np.linalg.norm((local(ob) - before)[middle], axis=1) > 1e-4).all()
    assert edit.surface == pytest.approx(evaluated(ob), abs=2e-6)
    edit.restore()
    assert snapshot() == start


@pytest.mark.parametrize("kind", KINDS)
def test_the_accepted_state_equals_blenders(kind: str) -> None:
    """Without modifiers the accepted surface and the vertices in Blender are the same numbers."""
    ob = tube(location=(10, -20, 5), rotation_euler=(0.2, 0.5, 0.4), scale=(0.7, 1.1, -1.3))
    select(ob)
    edit = begin(settings_of(kind))
    edit.apply(turn(0.4, "Y", (10, -20, 5)))
    assert edit.write().passed
    world = np.array(ob.matrix_world, float)
    assert np.abs(moved(world, local(ob).astype(float)) - edit.surface).max() < 1e-13


@pytest.mark.parametrize("pull", [0.0, 0.5], ids=["hard", "soft"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_handle_pressed_into_a_block_stops_at_it(kind: str, pull: float) -> None:
    ob = tube()
    add_modifier(ob, "SUBSURF", levels=1, render_levels=1)
    add_cube("Block", (1.6, 0, 2.0), 0.8)
    select(ob)
    before = local(ob)
    edit = begin(settings_of(kind, pull=pull))
    for step in range(1, 7):
        edit.drag(shift(0.15 * step))
        assert edit.write().passed
    edit.settle()
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()
    assert (local(ob)[members(ob, "Foot")] == before[members(ob, "Foot")]).all()
    assert 0.2 < local(ob)[members(ob, "Top")].mean(axis=0)[0] < 0.85


def test_selected_vertices_are_handles_in_edit_mode() -> None:
    ob = tube()
    ob.vertex_groups.active = ob.vertex_groups["Foot"]
    edit_mode(ob)
    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(ob.data)
    edited.verts.ensure_lookup_table()
    for number in members(ob, "Top"):
        edited.verts[number].select = True
    before = local(ob)
    edit = begin(settings_of("laplacian", groups=()))
    assert edit.apply(shift(0.4)).status == "reached"
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert local(ob)[members(ob, "Top")] == pytest.approx(before[members(ob, "Top")] + (0.4, 0, 0), abs=1e-6)
    assert (local(ob)[members(ob, "Foot")] == before[members(ob, "Foot")]).all()
    assert 0.05 < local(ob)[5 * 8 : 6 * 8].mean(axis=0)[0] < 0.35


def test_edit_mode_without_a_handle_leaves_the_mesh_an_obstacle() -> None:
    ob, cube = tube(), add_cube("Cube", (2, 0, 0), 0.5)
    edit_mode(ob, cube)
    for each, chosen in ((ob, False), (cube, True)):
        for vertex in bmesh.from_edit_mesh(each.data).verts:
            vertex.select = chosen
    before = local(ob)
    edit = begin(settings_of("laplacian", groups=()))
    assert {each.name: each.role for each in edit.summary.participants} == {"Tube": "obstacle", "Cube": "cage"}
    edit.apply(shift(-1.5))
    assert edit.write().passed
    ob.update_from_editmode()
    assert (local(ob) == before).all()
    assert check_scene(bpy.context).pairs == ()


def test_the_active_group_moves_if_it_is_a_handle() -> None:
    ob = tube()
    select(ob)
    before = local(ob)
    for active, moving, still in (("Top", "Top", "Foot"), ("Foot", "Foot", "Top")):
        ob.vertex_groups.active = ob.vertex_groups[active]
        edit = begin(settings_of("arap", groups=("Top", "Foot"), anchor=""))
        edit.drag(shift(0.2))
        assert edit.write().passed
        assert local(ob)[members(ob, moving)] == pytest.approx(before[members(ob, moving)] + (0.2, 0, 0), abs=1e-6)
        assert local(ob)[members(ob, still)] == pytest.approx(before[members(ob, still)], abs=1e-6)
        edit.restore()
    group(ob, "None of them", [])
    ob.vertex_groups.active = ob.vertex_groups["None of them"]
    edit = begin(settings_of("laplacian", groups=("Top", "Foot"), anchor=""))
    edit.drag(shift(0.2))
    assert edit.write().passed
    assert local(ob) == pytest.approx(before + (0.2, 0, 0), abs=1e-5)


def test_other_vertices_may_be_fixed() -> None:
    ob = tube()
    select(ob)
    before = local(ob)
    edit = begin(settings_of("laplacian", rest="stays", pull=1.0))
    edit.apply(shift(0.1))
    assert edit.write().passed
    others = np.setdiff1d(np.arange(len(before)), members(ob, "Top"))
    assert (local(ob)[others] == before[others]).all()
    assert (local(ob)[members(ob, "Top"), 0] > before[members(ob, "Top"), 0] + 0.01).all()


def test_weights_scale_the_stiffness_of_a_handle() -> None:
    moves = []
    for weight in (1.0, 0.1):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        ob = tube()
        group(ob, "Top", members(ob, "Top"), weight)
        select(ob)
        before = local(ob)
        edit = begin(settings_of("laplacian", pull=0.02))
        edit.apply(shift(0.5))
        assert edit.write().passed
        moves.append((local(ob) - before)[members(ob, "Top"), 0].mean())
    assert 0.01 < moves[1] < 0.8 * moves[0] < 0.4


def test_tiny_coordinates_of_anchors_stay_exactly() -> None:
    """Written by way of the world they came back changed: 1e-20 is lost beside a location of 1000."""
    ob = tube(location=(1000, 0.3, -77), rotation_euler=(0.3, 0.1, 0.2))
    for number in members(ob, "Foot"):
        ob.data.vertices[number].co.z = 1e-20 * (number + 1)
    select(ob)
    before = local(ob)
    for settings in (
        settings_of("laplacian"),
        EditSettings(object_response="deform", weights={"Tube": WeightGroup("Foot", True)}),
    ):
        edit = begin(settings)
        edit.drag(shift(0.2))
        assert edit.write().passed
        assert (local(ob)[members(ob, "Foot")] == before[members(ob, "Foot")]).all()
        assert not (local(ob) == before).all()
        edit.restore()


def test_unselected_objects_with_handles_yield() -> None:
    ob = tube()
    pusher = add_cube("Pusher", (2.0, 0, 2.5), 0.6)
    select(pusher)
    chosen = settings_of("laplacian")
    before = local(ob)
    edit = begin(
        EditSettings(
            responders="unselected",
            roles={"Tube": "controls"},
            deformations=chosen.deformations,
            handles=chosen.handles,
        )
    )
    edit.apply(shift(-1.3))
    assert edit.write().passed
    assert pusher.location.x == pytest.approx(0.7, abs=1e-6)
    assert local(ob)[members(ob, "Top")].mean(axis=0)[0] < -0.1
    assert (local(ob)[members(ob, "Foot")] == before[members(ob, "Foot")]).all()
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize(
    ("handles", "message"),
    [
        ({"groups": ()}, "it has no handle"),
        ({"groups": ("Topp",)}, 'there is no vertex group "Topp" for a handle'),
        ({"anchor": "Fuß"}, 'there is no vertex group "Fuß" for the anchor'),
        ({"anchor": "Top"}, 'no vertex of "Top" can be a handle'),
    ],
)
def test_invalid_handles_are_refused(handles: dict, message: str) -> None:
    ob = tube()
    select(ob)
    before = snapshot()
    with pytest.raises(stiv.InputError, match=f"Tube: (.*)?{message}"):
        begin(settings_of("arap", **handles))
    assert snapshot() == before


def test_the_deformation_of_an_object_may_be_rigid_its_lattice_or_its_vertices() -> None:
    ob = add_cube("Soft")
    lattice = add_lattice("Cage", (2, 2, 3), scale=(3, 3, 3))
    add_modifier(ob, "LATTICE", object=lattice)
    lattice.hide_set(True)
    select(ob)
    for kind, role in (("lattice", "lattice"), ("vertices", "cage")):
        edit = begin(EditSettings(deformations={"Soft": kind}))
        assert [each.role for each in edit.summary.participants] == [role]
        start = evaluated(ob)
        assert edit.drag(shift(0.5)).status == "reached"
        assert edit.write().passed
        assert evaluated(ob) == pytest.approx(start + (0.5, 0, 0), abs=1e-5)
        assert tuple(ob.location) == (0, 0, 0)
        edit.restore()
    ob.modifiers.clear()
    edit = begin(EditSettings(object_response="deform", deformations={"Soft": "rigid"}))
    assert [each.role for each in edit.summary.participants] == ["rigid"]
    with pytest.raises(stiv.InputError, match="Soft: no lattice deforms it"):
        begin(EditSettings(deformations={"Soft": "lattice"}))


def test_a_grid_keeps_its_folds_apart() -> None:
    """A sheet bent onto itself by its edge: self-contact of a soft mesh."""
    ob = add_grid("Tube", 12)
    row = np.array([tuple(v.co) for v in ob.data.vertices])
    group(ob, "Top", np.flatnonzero(row[:, 0] > 0.95))
    group(ob, "Foot", np.flatnonzero(row[:, 0] < -0.4))
    select(ob)
    edit = begin(settings_of("arap"), "rotate")
    edit.apply(turn(-2.8, "Y", (0.1, 0, 0.1)), path=lambda fraction: turn(-2.8 * fraction, "Y", (0.1, 0, 0.1)))
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()
    assert local(ob)[members(ob, "Top")][:, 2].mean() > 0.05
