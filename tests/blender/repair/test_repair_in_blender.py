# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction, expansion and repair of Blender's objects, examined without the package, except for its exact test."""

import time

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, mesh, select, snapshot

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.tangled import hairpin
from stiv import deadlines
from stiv.blender import (
    ContractionSettings,
    EditSettings,
    ExpansionSettings,
    RepairSettings,
    check_scene,
    contract_scene,
    expand_scene,
    repair_scene,
)
from stiv.blender.repair.rest_shape import NAME, read_rest_shape
from stiv.blender.verify.verification import Verification, Verifier


def add_tube(name="Tube", radius=0.28, **properties):
    tube = hairpin(radius, rings=24, sides=8)
    return add(name, mesh(name, tube.positions, tube.surface.triangles.tolist()), **properties)


def add_ball(name, radius=1.0, location=(0, 0, 0), levels=2):
    ball = icosphere(levels)
    return add(name, mesh(name, radius * ball.vertices, ball.faces), location)


def pairs_shown() -> int:
    """How many pairs of triangles Blender's evaluation has, by the core's exact test on triangles read here."""
    points, triangles, first = [np.zeros((0, 3))], [np.zeros((0, 3), int)], 0
    graph = bpy.context.evaluated_depsgraph_get()
    for ob in bpy.context.view_layer.objects:
        if ob.type != "MESH" or not ob.visible_get():
            continue
        shown = ob.evaluated_get(graph)
        copy = shown.to_mesh()
        copy.calc_loop_triangles()
        triangles.append(np.array([t.vertices for t in copy.loop_triangles], int).reshape(-1, 3) + first)
        points.append(np.array([shown.matrix_world @ v.co for v in copy.vertices], float).reshape(-1, 3))
        first += len(copy.vertices)
        shown.to_mesh_clear()
    return len(stiv.find_intersections(np.concatenate(points), np.concatenate(triangles).astype(np.int32)))


def relative_rms(before, after) -> float:
    return np.sqrt(((after - before) ** 2).sum(axis=1).mean()) / np.linalg.norm(np.ptp(before, axis=0))


def test_a_tangled_mesh_is_repaired_and_its_rest_shape_stored() -> None:
    tube = add_tube(location=(3, -2, 5), scale=(2, 2, -2))
    select(tube)
    before, local = evaluated(tube), [tuple(v.co) for v in tube.data.vertices]
    count = pairs_shown()
    report = repair_scene(bpy.context)
    assert (report.status, report.changed, report.pairs) == ("repaired", True, ())
    assert report.pairs_before == count > 60
    assert pairs_shown() == 0
    assert relative_rms(before, evaluated(tube)) == pytest.approx(report.deviation, rel=1e-3)
    assert report.deviation < 0.02
    assert [tuple(value.vector) for value in tube.data.attributes[NAME].data] == local


def test_a_cage_under_subdivision_is_repaired() -> None:
    tube = add_tube(radius=0.3)
    add_modifier(tube, "SUBSURF", levels=1)
    select(tube)
    assert pairs_shown() > 60
    before = evaluated(tube)
    report = repair_scene(bpy.context)
    assert report.status == "repaired"
    assert pairs_shown() == 0 == len(check_scene(bpy.context).pairs)
    assert relative_rms(before, evaluated(tube)) < 0.03


def test_a_body_leaves_the_shirt_that_it_intersects() -> None:
    """As in the paper's Figure 1: other objects are not touched."""
    body = add_ball("Body", 1.03)
    angle = np.linspace(0, 2 * np.pi, 25)[:-1]
    rows = [(np.cos(a) * 1.02, np.sin(a) * 1.02, z) for z in np.linspace(-0.4, 0.4, 6) for a in angle]
    faces = [(24 * r + k, 24 * r + (k + 1) % 24, 24 * r + 24 + (k + 1) % 24, 24 * r + 24 + k)
             for r in range(5) for k in range(24)]  # fmt: skip
    shirt = add("Shirt", mesh("Shirt", rows, faces))
    select(body)
    assert pairs_shown() > 60
    before = snapshot()["Shirt"]
    report = repair_scene(bpy.context)
    assert (report.status, report.contracted) == ("repaired", "Body")
    assert pairs_shown() == 0
    assert snapshot()["Shirt"] == before
    assert (np.linalg.norm(evaluated(body)[:, :2], axis=1) < 1.02).all()
    assert shirt.data.attributes.get(NAME) is None


def test_two_objects_at_once() -> None:
    one, two = add_ball("One"), add_ball("Two", 0.7, (1.6, 0.1, 0.05))
    select(one, two)
    assert pairs_shown() > 0
    assert repair_scene(bpy.context).status == "repaired"
    assert pairs_shown() == 0


def test_only_selected_vertices_move_in_edit_mode() -> None:
    plate, wall = add_grid("Plate", 10), add("Wall", mesh("Wall", [(0.5, -3, -0.1), (0.5, 3, -0.1), (0.52, 0, 0.07)],
                                                          [(0, 1, 2)]))  # fmt: skip
    points = np.array([v.co for v in plate.data.vertices])
    chosen = (points[:, 0] > 0) & (points[:, 0] < 0.95)
    edit_mode(plate)
    edited = bmesh.from_edit_mesh(plate.data)
    for vertex, is_chosen in zip(edited.verts, chosen, strict=True):
        vertex.select = bool(is_chosen)
    edited.select_flush(True)
    selected = np.array([v.select for v in edited.verts])
    report = contract_scene(bpy.context, ContractionSettings(steps=2))
    assert report.status == "contracted"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = np.array([v.co for v in plate.data.vertices])
    assert np.array_equal(after[~selected], points[~selected])
    assert wall.data.vertices[2].co.z == np.float32(0.07)
    assert read_rest_shape(plate).tolist() == points.astype(np.float32).tolist()


@pytest.mark.parametrize("what", ["coincident", "too far", "held"])
def test_a_failed_repair_changes_nothing_and_lists_the_pairs(what: str) -> None:
    one = add_ball("One", levels=1)
    two = add_ball("Two", 1.0 if what == "coincident" else 0.8, levels=1)
    two.location = (0, 0, 0) if what == "coincident" else (1.0, 0.1, 0.05)
    if what == "held":
        lid = add_cube("Lid", (5, 0, 0), 0.5)
        select(lid)
    else:
        select(one, two)
    before = snapshot()
    settings = RepairSettings(max_deviation=1e-6 if what == "too far" else 0.05)
    report = repair_scene(bpy.context, settings)
    assert snapshot() == before
    if what == "held":  # what does not move is not repaired, and is none of this one's affair
        assert (report.status, report.pairs) == ("already_free", ())
        return
    assert (report.status, report.changed) == ("refused", False)
    assert {"coincident": "triangles coincide", "too far": "deviates"}[what] in report.message
    assert {pair.first.object for pair in report.pairs} | {pair.second.object for pair in report.pairs} == {
        "One",
        "Two",
    }
    assert len(report.pairs) == report.pairs_before > 0


def test_a_cancelled_repair_changes_nothing() -> None:
    tube = add_tube()
    add_modifier(tube, "SUBSURF", levels=1)
    select(tube)
    before, token, calls = snapshot(), stiv.CancelToken(), []

    def progress(phase: str, fraction: float) -> None:
        calls.append(phase)
        if len(calls) == 4:
            token.cancel()

    report = repair_scene(bpy.context, cancel=token, progress=progress)
    assert (report.status, report.changed) == ("cancelled", False)
    assert snapshot() == before


def test_contracting_step_by_step_and_expanding_to_the_rest_shape() -> None:
    tube = add_tube()
    select(tube)
    before = evaluated(tube)
    first = contract_scene(bpy.context)
    assert first.status == "contracted" and first.changed
    assert len(first.pairs) == pairs_shown()
    report = contract_scene(bpy.context, ContractionSettings(steps=12, until_free=True))
    assert report.pairs == () and pairs_shown() == 0
    contracted = relative_rms(before, evaluated(tube))
    grown = expand_scene(bpy.context)
    assert (grown.status, pairs_shown()) == ("corrected", 0)
    assert relative_rms(before, evaluated(tube)) < 0.5 * contracted
    settled = expand_scene(bpy.context, ExpansionSettings(EditSettings(smoothness=0.01), rounds=3))
    assert pairs_shown() == 0
    assert settled.status in ("corrected", "blocked", "unchanged")


def test_a_complete_expansion_removes_the_rest_shape() -> None:
    ball = add_ball("Ball")
    select(ball)
    before = evaluated(ball)
    contract_scene(bpy.context, ContractionSettings(steps=5))
    assert relative_rms(before, evaluated(ball)) > 0.05
    assert expand_scene(bpy.context, ExpansionSettings(amount=0.5)).status == "reached"
    assert read_rest_shape(ball) is not None
    assert expand_scene(bpy.context).status == "reached"
    assert np.array_equal(evaluated(ball), before)
    assert read_rest_shape(ball) is None


def test_meshes_without_a_rest_shape_yield_to_an_expansion() -> None:
    ball, other = add_ball("Ball"), add_ball("Other", 1.0, (1.9, 0, 0))
    select(ball)
    contract_scene(bpy.context, ContractionSettings(steps=12, until_free=True))
    assert pairs_shown() == 0
    before, contracted = evaluated(other), [vertex.co.copy() for vertex in ball.data.vertices]
    grown = expand_scene(bpy.context)
    alone = np.linalg.norm(evaluated(ball), axis=1).min()
    assert np.array_equal(evaluated(other), before)
    for vertex, position in zip(ball.data.vertices, contracted, strict=True):
        vertex.co = position
    select(ball, other)
    report = expand_scene(bpy.context)
    assert grown.status == report.status == "corrected" and report.result.rounds > 0
    assert pairs_shown() == 0
    assert not np.array_equal(evaluated(other), before)
    assert np.linalg.norm(evaluated(ball), axis=1).min() > alone
    ball.data.attributes.remove(ball.data.attributes[NAME])
    with pytest.raises(stiv.InputError, match="it has no rest shape"):
        expand_scene(bpy.context)


def test_expansion_toward_another_object_stops_at_obstacles() -> None:
    ball, shape = add_ball("Ball"), add_ball("Shape", 2.0, (9, 0, 0))
    add_cube("Wall", (2.5, 0, 0), 1.0)
    select(ball)
    report = expand_scene(bpy.context, ExpansionSettings(target="Shape"))
    assert report.status == "corrected"
    assert pairs_shown() == 0
    after = evaluated(ball)
    assert after[:, 0].max() < 1.5 and after[:, 0].min() == pytest.approx(-2.0, abs=0.05)
    assert shape.data.vertices[0].co.length == pytest.approx(2.0)


def test_seams_are_welded_on_request() -> None:
    tube = hairpin(0.28, rings=24, sides=8)
    loose = tube.positions[tube.surface.triangles.ravel()]
    ob = add("Seams", mesh("Seams", loose, np.arange(len(loose)).reshape(-1, 3).tolist()))
    select(ob)
    data = ob.data
    report = repair_scene(bpy.context, RepairSettings(weld=True))
    assert report.status == "repaired"
    assert (len(ob.data.vertices), ob.data, pairs_shown()) == (tube.surface.vertex_count, data, 0)
    assert list(bpy.data.meshes.keys()) == ["Seams"]


def test_the_weld_of_a_failed_repair_is_undone() -> None:
    two = [add_ball("One", levels=1), add_ball("Two", levels=1)]
    select(*two)
    before = snapshot()
    assert repair_scene(bpy.context, RepairSettings(weld=True)).status == "refused"
    assert snapshot() == before


def test_errors_name_the_object_and_change_nothing() -> None:
    ball, lattice, far = add_ball("Ball"), add("Bars", bpy.data.lattices.new("Bars")), add_cube("Far", (0, 0, -9))
    select(ball, lattice)
    before = snapshot()
    with pytest.raises(stiv.InputError, match="Bars: only meshes"):
        repair_scene(bpy.context)
    select(ball)
    before = snapshot()
    with pytest.raises(stiv.InputError, match="Ball: it has no rest shape"):
        expand_scene(bpy.context)
    with pytest.raises(stiv.InputError, match="Nobody: is not a mesh of this file"):
        expand_scene(bpy.context, ExpansionSettings(target="Nobody"))
    add_modifier(ball, "SHRINKWRAP", "Wrap", target=far)
    with pytest.raises(stiv.InputError, match='Ball: Shrinkwrap "Wrap" projects onto "Far"; edit that'):
        repair_scene(bpy.context)
    ball.modifiers.clear()
    edit_mode(ball)
    with pytest.raises(stiv.InputError, match="cannot be welded in Edit Mode"):
        repair_scene(bpy.context, RepairSettings(weld=True))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert snapshot() == before


def test_a_repair_names_the_object_whose_topology_changes() -> None:
    ball = add_ball("Ball", levels=2)
    add_modifier(ball, "EDGE_SPLIT", split_angle=0.4)  # cuts other edges of the contracted shape
    add_cube("Block", location=(1, 0, 0.1), size=0.5)
    select(ball)
    before = snapshot()
    with pytest.raises(stiv.InputError, match=r"^Ball: its topology changes as it moves; apply its modifiers$"):
        repair_scene(bpy.context)
    assert snapshot() == before


def test_an_intersecting_repair_is_undone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blender's evaluation decides: here it rejects the written repair."""
    tube = add_tube()
    select(tube)
    before, seen = snapshot(), []

    def refuse(self, context, accepted) -> Verification:
        seen.append(np.abs(evaluated(tube) - accepted).max())
        return Verification(False, (), "said so")

    monkeypatch.setattr(Verifier, "verify", refuse)
    report = repair_scene(bpy.context)
    assert max(seen) < 1e-6
    assert (report.status, report.changed) == ("refused", False)
    assert report.message == "repaired, but said so" and len(report.pairs) == report.pairs_before
    assert snapshot() == before
    contract_scene(bpy.context, ContractionSettings(steps=12, until_free=True))
    contracted = snapshot()
    assert expand_scene(bpy.context).changed is False
    assert snapshot() == contracted


def test_an_exception_restores_everything(monkeypatch: pytest.MonkeyPatch) -> None:
    tube = add_tube()
    select(tube)
    before = snapshot()

    def fail(self, context, accepted) -> Verification:
        raise MemoryError

    monkeypatch.setattr(Verifier, "verify", fail)
    for settings in (RepairSettings(), RepairSettings(weld=True)):
        with pytest.raises(MemoryError):
            repair_scene(bpy.context, settings)
        assert snapshot() == before


def test_repair_of_a_shared_mesh_keeps_its_users_free() -> None:
    tube = add_tube()
    other = add("Other", tube.data, (9, 0, 0))
    select(tube)
    assert repair_scene(bpy.context).status == "repaired"
    assert other.data == tube.data
    assert check_scene(bpy.context).pairs == ()


def test_welding_refuses_shared_meshes_and_shape_keys_by_name() -> None:
    tube = add_tube()
    other = add("Other", tube.data, (9, 0, 0))
    select(tube)
    with pytest.raises(stiv.InputError, match='Tube: its mesh is shared with "Other"'):
        repair_scene(bpy.context, RepairSettings(weld=True))
    bpy.data.objects.remove(other)
    for name in ("Basis", "Bent"):
        tube.shape_key_add(name=name)
    with pytest.raises(stiv.InputError, match="Tube: has shape keys and cannot be welded"):
        repair_scene(bpy.context, RepairSettings(weld=True))


@pytest.mark.shared
def test_a_time_limit_leaves_the_start_or_the_best_repair_and_says_so() -> None:
    tube = add_tube()
    select(tube)
    before = snapshot()
    report = repair_scene(bpy.context, RepairSettings(EditSettings(time_budget=1e-9)))
    assert (report.status, report.changed) == ("budget", False)
    assert report.message == "allow more time, or select fewer objects"
    assert snapshot() == before
    begin, rounds = time.monotonic(), 0

    def wait_in_second_round(phase: str, fraction: float) -> None:
        nonlocal rounds
        rounds += phase == "rounds"
        while rounds > 1 and time.monotonic() < begin + 3.1:
            time.sleep(0.01)

    settings = RepairSettings(EditSettings(time_budget=3.0), max_deviation=10.0)
    report = repair_scene(bpy.context, settings, progress=wait_in_second_round)
    assert (report.status, report.message) == ("repaired", "time limit reached; raise it to come closer")
    assert pairs_shown() == 0


def test_a_time_limit_keeps_the_steps_of_a_contraction() -> None:
    tube = add_tube()
    select(tube)
    once = contract_scene(bpy.context)
    after_one = evaluated(tube)
    bpy.data.objects.remove(tube)
    tube = add_tube()
    select(tube)
    report = contract_scene(bpy.context, ContractionSettings(EditSettings(time_budget=1e-9), steps=12))
    assert (once.status, report.status, report.changed) == ("contracted", "budget", True)
    assert np.array_equal(evaluated(tube), after_one)
    assert len(report.pairs) == pairs_shown() and read_rest_shape(tube) is not None


def test_a_time_limit_without_a_better_step_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deadlines, "LEAST_TIME", 1e-9)
    select(add_tube())
    before = snapshot()
    settings = ContractionSettings(EditSettings(time_budget=1e-9), steps=12, until_free=True)
    report = contract_scene(bpy.context, settings)
    assert (report.status, report.changed) == ("budget", False)
    assert report.message == "allow more time, or select fewer objects"
    assert snapshot() == before


@pytest.mark.shared
@pytest.mark.parametrize("rounds", [1, 4])
def test_a_time_limit_keeps_the_last_clear_state_of_an_expansion(rounds: int) -> None:
    tube = add_tube()
    select(tube)
    rest = evaluated(tube)
    contract_scene(bpy.context, ContractionSettings(steps=12, until_free=True))
    start = relative_rms(rest, evaluated(tube))
    begin, calls = time.monotonic(), 0

    def wait_late(phase: str, fraction: float) -> None:
        nonlocal calls
        calls += 1
        while calls > 12 and time.monotonic() < begin + 2.1:
            time.sleep(0.01)

    settings = ExpansionSettings(EditSettings(time_budget=2.0), rounds=rounds)
    report = expand_scene(bpy.context, settings, progress=wait_late)
    reached = relative_rms(rest, evaluated(tube))
    assert (report.status, report.changed) == ("budget", True)
    assert pairs_shown() == 0 and reached < start
    assert expand_scene(bpy.context, ExpansionSettings(rounds=2)).status in ("corrected", "blocked")
    assert pairs_shown() == 0 and relative_rms(rest, evaluated(tube)) < reached
