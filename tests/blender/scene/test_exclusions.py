# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that intersect and are edited all the same: excluded pairs stay, all others are guarded."""

from dataclasses import replace
from itertools import pairwise

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, mesh, select, shift, snapshot

import stiv
from stiv.blender import BlenderEdit, EditSettings, Exclusions, check_scene
from stiv.blender.scene.exclusions import drop_stale, intersection_notes
from stiv.blender.verify.scene_check import find_exclusions

DEFORM = EditSettings(object_response="deform")


def excluded_now() -> Exclusions:
    excluded, others = find_exclusions(bpy.context)
    assert others == ()
    return excluded


def meeting() -> set[frozenset[tuple[str, int]]]:
    """Pairs of faces that meet now."""
    return {
        frozenset(((pair.first.object, pair.first.number), (pair.second.object, pair.second.number)))
        for pair in check_scene(bpy.context).pairs
    }


def stuck_cube() -> tuple:
    """A cube that stands in a grid, a second one apart, and a wall."""
    grid, stuck = add_grid("Grid", 8, 3.0), add_cube("Stuck", (0.1, 0.15, 0.2), 0.5)
    return grid, stuck, add_cube("Free", (0, 0, 3.0), 0.5)


def test_intersections_are_refused_until_they_are_excluded() -> None:
    _, _, free = stuck_cube()
    select(free)
    add_cube("Other", (1.5, 0, 3.0), 0.5)
    with pytest.raises(stiv.StartIntersectsError):
        select(bpy.data.objects["Stuck"])
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
    select(bpy.data.objects["Grid"], free)
    settings = replace(DEFORM, excluded=excluded_now())
    edit = BlenderEdit.begin(bpy.context, settings, "move")
    assert edit.summary.warnings == ("Grid cuts Stuck, 8 faces, may only part",)
    assert edit.apply(shift(x=3.0)).status in ("corrected", "blocked")
    report = edit.write()
    assert report.passed, report.message
    assert {frozenset(name for name, _ in pair) for pair in meeting()} <= {frozenset(("Grid", "Stuck"))}


@pytest.mark.parametrize("way", [(0, 0, 2.0), (0, 0, -2.0), (1.0, 0.3, 0), (0, 0, 0.1)])
def test_only_excluded_objects_ever_intersect(way) -> None:
    grid, _, _ = stuck_cube()
    add_modifier(grid, "SUBSURF", levels=1, render_levels=1)
    edit_mode(grid)
    edited = grid.data
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(excluded=excluded_now()), "move")
    edit.apply(shift(*way))
    edit.write()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert {frozenset(name for name, _ in pair) for pair in meeting()} <= {frozenset(("Grid", "Stuck"))}
    assert edited is grid.data


def test_cancelling_restores_everything() -> None:
    grid, _, _ = stuck_cube()
    select(grid)
    before = snapshot()
    edit = BlenderEdit.begin(bpy.context, replace(DEFORM, excluded=excluded_now()), "move")
    edit.drag(shift(z=0.2))
    edit.write()
    edit.restore()
    assert snapshot() == before


def test_exclusions_of_a_mesh_that_changed_are_dropped_with_a_message() -> None:
    grid, stuck, _ = stuck_cube()
    excluded = excluded_now()
    kept = Exclusions.from_json(excluded.to_json())
    assert kept == excluded and len(kept.pairs) > 3
    select(stuck)
    stuck.location.x += 0.01  # the same faces: nothing is stale
    bpy.context.view_layer.update()
    moved = evaluated(stuck)
    current, message = drop_stale(kept, read_meshes())
    assert (current, message) == (kept, "")
    grid.data.vertices[0].co.x -= 0.1
    grid.data.update()
    assert drop_stale(kept, read_meshes())[1] == ""
    add_modifier(grid, "SUBSURF", levels=1, render_levels=1)
    bpy.context.view_layer.update()
    current, message = drop_stale(kept, read_meshes())
    assert current.pairs == frozenset() and list(current.shapes) == ["Stuck"]
    assert message == "Grid: the faces have changed, so their exclusions are dropped"
    with pytest.raises(stiv.StartIntersectsError):
        BlenderEdit.begin(bpy.context, EditSettings(excluded=kept), "move")
    assert np.array_equal(evaluated(stuck), moved)


def read_meshes():
    from stiv.blender.scene.evaluated_scene import read_scene

    return read_scene(bpy.context, evaluations=("shown", "viewport")).meshes


def test_loose_elements_cannot_be_excluded() -> None:
    add_grid("Grid", 3, 1.5)
    add("Wire", mesh("Wire", [(0.2, 0.1, -1), (0.2, 0.1, 1)], [], [(0, 1)]))
    excluded, others = find_exclusions(bpy.context)
    assert excluded.pairs == frozenset()
    assert [pair.first.kind for pair in others] == ["edge"]


@pytest.mark.parametrize("text", ["{", "[]", '{"pairs": [[1]], "shapes": {}}', '{"pairs": [], "shapes": []}'])
def test_unreadable_exclusions_name_the_way_out(text: str) -> None:
    with pytest.raises(stiv.InputError, match="use Clear Excluded Collisions"):
        Exclusions.from_json(text)


def test_a_value_that_only_goes_deeper_costs_little_however_far_it_is() -> None:
    add_cube("Rest", (0, 0, 0))
    cube = add_cube("Cube", (1.7, 0.1, 0.2))
    select(cube)
    settings = EditSettings(excluded=excluded_now())
    tries = []
    for way in (-2.0, -200.0):
        edit = BlenderEdit.begin(bpy.context, settings, "move")
        result = edit.apply(shift(x=way))
        assert result.status == "blocked"
        assert edit.write().passed
        tries.append(result.counters["acceptance_tries"])
        edit.restore()
    assert 0 < tries[1] <= 10 * tries[0]  # the far way adds two goals and eight detours that gain nothing


def test_notes_name_a_few_objects_the_moving_ones_first_and_count_the_others() -> None:
    names = "ABCDEF"
    alone = [((name, 0), (name, 1)) for name in names]
    cut = [((first, 2), (second, 2)) for first, second in pairwise(names[:5])]
    notes = intersection_notes(Exclusions.of_pairs(alone + cut), {"D"})
    assert notes == (
        "C cuts D, 2 faces, may only part", "D cuts E, 2 faces, may only part", "A cuts B, 2 faces, may only part",
        "B cuts C, 2 faces, may only part", "D intersects itself, 2 faces, left as it is",
        "A intersects itself, 2 faces, left as it is", "B intersects itself, 2 faces, left as it is",
        "3 more objects intersect themselves, left as they are",
    )  # fmt: skip


def test_a_note_counts_the_faces_that_touch_too() -> None:
    cut, touching = (("A", 0), ("A", 1)), (("A", 1), ("A", 2))
    exclusions = [Exclusions.of_pairs(pairs) for pairs in ([cut], [cut, touching])]
    assert intersection_notes(exclusions[0], {"A"}, exclusions[0]) == ("A intersects itself, 2 faces, left as it is",)
    assert intersection_notes(exclusions[0], {"A"}, exclusions[1]) == (
        "A cuts or touches itself, 3 faces, left as it is",
    )
