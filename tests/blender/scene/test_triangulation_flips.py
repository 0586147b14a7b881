# SPDX-License-Identifier: GPL-3.0-or-later
"""A quad that bends until Blender flips its diagonal, with a post in the place of the flip."""

from itertools import count
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, edit_mode, evaluated, mesh, select, shift

import stiv
from stiv import deadlines
from stiv.blender import BlenderEdit, EditSettings, check_scene, read_surface
from stiv.blender.edit import state_writer
from stiv.blender.edit.solver import EditSolver
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.triangulation_flips import (
    add_triangles,
    find_flips,
    guard_bent_quads,
    with_current_triangulation,
)
from tests.stepping import run_cancelled

WINGS = (1, 3)


def add_quad(height: float) -> Any:
    """A square cut along the x axis, its two other corners raised."""
    corners = [(-1, 0, 0), (0, -1, height), (1, 0, 0), (0, 1, height)]
    return add("Quad", mesh("Quad", corners, [(0, 1, 2, 3)]))


def add_post() -> Any:
    return add_cube("Post", (0, 0, 3.3), 1, scale=(0.02, 0.02, 3))  # from z = 0.3 up


def raise_wings(quad: Any, height: float) -> None:
    for index in WINGS:
        quad.data.vertices[index].co.z = height
    quad.data.update()
    bpy.context.view_layer.update()


def read() -> Assembly:
    meshes = read_scene(bpy.context).meshes
    return assemble(meshes, ["deformable"] * len(meshes))


def test_a_flip_is_found_and_added_once() -> None:
    quad = add_quad(0.1)
    assembly = read()
    assert find_flips(bpy.context, assembly) == ()
    raise_wings(quad, 2)
    (cut,) = find_flips(bpy.context, assembly)
    assert cut.new.faces.tolist() == [0, 0]
    assert with_current_triangulation(assembly, [cut]).surface.triangles.tolist() == read().surface.triangles.tolist()
    extended = add_triangles(assembly, [cut.new])
    assert len(extended.surface.triangles) == 4
    assert [extended.face(k).number for k in range(4)] == [0] * 4
    assert extended.surface.flip_faces == ((0, 1, 2, 3),)
    assert find_flips(bpy.context, extended) == ()
    assert len(stiv.find_intersections(extended.positions, extended.surface)) == 0


@pytest.mark.parametrize(("height", "post", "triangles"), [(0.1, False, 2), (0.8, False, 4), (0.8, True, 2)])
def test_bent_quads_keep_both_triangulations_if_both_are_free(height: float, post: bool, triangles: int) -> None:
    add_quad(height)
    if post:
        add_post()
    assembly = read()
    extra = len(guard_bent_quads(assembly).surface.triangles) - len(assembly.surface.triangles)
    assert 2 + extra == triangles


def test_the_second_triangulation_is_the_one_that_blender_flips_to() -> None:
    quad = add_quad(0.8)
    extended = guard_bent_quads(read())
    raise_wings(quad, 2)
    present = {tuple(sorted(row)) for row in read().surface.triangles.tolist()}
    assert {tuple(sorted(row)) for row in extended.surface.triangles[2:].tolist()} == present


def begin_with_wings(quad: Any, **settings: Any) -> BlenderEdit:
    edit_mode(quad)
    bpy.ops.mesh.select_all(action="DESELECT")
    import bmesh

    for vertex in bmesh.from_edit_mesh(quad.data).verts:
        vertex.select = vertex.index in WINGS
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), "move")


def test_an_edit_that_would_flip_into_a_post_is_deflected() -> None:
    quad = add_quad(0)
    add_post()
    edit = begin_with_wings(quad)
    edit.apply(shift(z=2))
    report = edit.write()
    assert report.passed
    assert report.message == ""
    assert report.result is not None
    assert check_scene(bpy.context).pairs == ()
    assert evaluated(quad)[WINGS, 2].min() > 0.2


def test_a_drag_repeats_its_solves_only_within_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twenty calls since the last picture; then it continues from a free state to the last goal."""
    quad = add_quad(0)
    add_post()
    edit = begin_with_wings(quad, time_budget=10.0)
    for height in np.linspace(0.1, 2, 20):
        edit.drag(shift(z=height))
    solved, solve, clock = [], EditSolver.solve, SimpleNamespace(monotonic=count(0, 100).__next__)
    monkeypatch.setattr(deadlines, "time", clock)
    monkeypatch.setattr(EditSolver, "solve", lambda solver, goal, **limits: solved.append(goal) or solve(solver, goal))
    report = edit.write()
    assert report.passed and report.result is not None and 0 < len(solved) <= 2
    assert check_scene(bpy.context).pairs == () and np.array_equal(solved[-1], edit.goal)


def write_and_watch(
    edit: BlenderEdit, quad: Any, is_cancelled: bool = False
) -> tuple[state_writer.WriteReport, list[float]]:
    """The report of a write, and the height of the wings that the scene shows at each of its steps."""
    steps, shown, outcome = edit.write_steps(), [], None
    while True:
        try:
            call = steps.send(outcome)
        except StopIteration as end:
            return end.value, shown
        shown.append(evaluated(quad)[WINGS, 2].max())
        outcome = is_cancelled if call is None else call.run()


def test_a_write_shows_the_last_written_state_while_it_solves_again() -> None:
    """Others look at the scene then: the window draws it, and may save it."""
    quad = add_quad(0)
    add_post()
    edit = begin_with_wings(quad)
    edit.apply(shift(z=2))
    report, shown = write_and_watch(edit, quad)
    assert len(shown) > 1 and set(shown) == {0.0}
    assert report.passed and evaluated(quad)[WINGS, 2].min() > 0.2


def test_a_search_for_an_older_state_shows_the_last_written_state_and_ends_when_cancelled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a path whose end cannot be solved again. It may take seconds, in which the window draws the scene."""
    found = {}
    for is_cancelled in (False, True):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        quad = add_quad(0)
        add_post()
        edit = begin_with_wings(quad)
        monkeypatch.setattr(EditSolver, "retry_with", lambda solver, flips, end: iter(()))
        monkeypatch.setattr(state_writer, "nudged", lambda controls, last: iter(()))
        for height in np.linspace(0.1, 2, 20):
            edit.drag(shift(z=height))
        report, shown = write_and_watch(edit, quad, is_cancelled)
        assert len(shown) > 0 and set(shown) == {0.0}
        assert report.message and check_scene(bpy.context).pairs == ()
        found[is_cancelled] = len(shown), evaluated(quad)[WINGS, 2].min()
    assert found[True][0] < found[False][0] and 0.89 < found[False][1] < 1.1
    assert found[True][1] <= found[False][1]


def test_a_write_that_is_cancelled_ends_at_a_state_that_passes() -> None:
    """At any time: while a session with the flipped triangles is made, while it solves, or in the search."""
    for before in range(100):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        quad = add_quad(0)
        add_post()
        edit = begin_with_wings(quad)
        edit.drag(shift(z=2))
        report, steps = run_cancelled(edit.write_steps(), before)
        assert check_scene(bpy.context).pairs == () and edit.is_shown()
        if report.result is not None:
            assert (report.result.status == "cancelled") == (before < steps)
        if before >= steps:
            break
    assert before > 2


def test_a_drag_past_the_post_stops_before_the_flip_and_returns() -> None:
    quad = add_quad(0)
    add_post()
    edit = begin_with_wings(quad)
    heights = []
    for height in [*np.linspace(0.1, 2, 20), 0.5]:
        edit.drag(shift(z=height))
        report = edit.write()
        assert check_scene(bpy.context).pairs == ()
        assert report.passed or "Post" in report.message
        heights.append(float(evaluated(quad)[WINGS, 2].min()))
    assert heights[:9] == pytest.approx(np.linspace(0.1, 0.9, 9), abs=1e-6)
    assert min(heights[9:-1]) > 0.89
    assert heights[-1] == pytest.approx(0.5, abs=1e-6)


def test_nothing_of_the_flip_remains_after_returning() -> None:
    quad = add_quad(0)
    add_post()
    select(quad)
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")
    start = read_surface(bpy.context).positions
    edit.apply(shift(x=0.5))
    edit.write()
    edit.restore()
    assert np.array_equal(read_surface(bpy.context).positions, start)
