# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit scripts on mesh files."""

import json

import numpy as np
import pytest
from oracles import rational

import stiv
from stiv.command_line import program
from stiv.edit_scripts import parse_edit_script
from stiv.mesh_files import Mesh, read_mesh
from stiv.mesh_files.mesh import checked_mesh
from stiv.mesh_replay import replay_on_mesh

SHEET = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def two_sheets(gap: float = 1.0) -> Mesh:
    vertices = np.vstack([SHEET, 0.5 * SHEET + (0, 0, gap)])
    return checked_mesh(vertices, np.vstack([FACES, FACES + 4]), ("Below", "Above ü"), np.array([0, 0, 1, 1], np.int32))


def edited(*steps, mesh=None, **settings):
    data = {"schema": "stiv-edits", "version": 1, "settings": settings, "steps": list(steps)}
    return replay_on_mesh(parse_edit_script(data), two_sheets() if mesh is None else mesh)


def move(z, **more):
    return {"operator": "move", "objects": ["Above ü"], "values": {"value": [0, 0, z]}, **more}


def test_an_object_without_contact_reaches_its_goal():
    mesh, (report,) = edited(move(-0.5))
    np.testing.assert_allclose(mesh.vertices[4:], two_sheets().vertices[4:] - (0, 0, 0.5), atol=1e-12)
    np.testing.assert_array_equal(mesh.vertices[:4], SHEET)
    assert report["status"] == "reached" and report["rounds"] == 0


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_an_object_does_not_pass_through_another(mode):
    mesh, (report,) = edited(move(-1.5, mode=mode))
    assert report["rounds"] > 0
    assert (mesh.vertices[4:, 2] > 0).all() and mesh.vertices[4:, 2].max() < 1
    assert len(stiv.find_intersections(mesh.vertices, mesh.triangles)) == 0


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_a_tight_edit_ends_no_further_from_its_goal(mode):
    (_, (smooth,)), (mesh, (tight,)) = (edited(move(-1.5, mode=mode), tight=tight) for tight in (False, True))
    assert tight["energy"] <= smooth["energy"]
    assert len(stiv.find_intersections(mesh.vertices, mesh.triangles)) == 0


def test_a_seam_stays_closed_where_one_side_of_it_is_moved():
    apart = np.concatenate([SHEET[FACES].reshape(-1, 3), 0.5 * SHEET[FACES].reshape(-1, 3) + (0, 0, 1)])
    owners = np.array([0, 0, 1, 1], np.int32)
    mesh = checked_mesh(apart, np.arange(12).reshape(4, 3), ("Below", "Above ü"), owners)
    mesh, (report,) = edited(move(-1.5, mode="EDIT", points=[0, 1]), mesh=mesh)
    assert report["rounds"] > 0
    assert mesh.vertices[[6, 7], 2].max() < 0.1 < mesh.vertices[10, 2]
    for one, other in ((6, 9), (8, 10)):
        np.testing.assert_array_equal(mesh.vertices[one], mesh.vertices[other])
    places, index = np.unique(mesh.vertices, axis=0, return_inverse=True)
    assert rational.find_intersections(places, index.reshape(-1)[mesh.triangles]) == set()


def test_points_are_counted_within_their_object():
    mesh, _ = edited(move(-0.5, mode="EDIT", points=[2]))
    assert mesh.vertices[:, 2].tolist() == [0, 0, 0, 0, 1, 1, 0.5, 1]


def test_rotation_and_scaling_use_the_mean_as_centre():
    turn = {"operator": "rotate", "objects": ["Above ü"], "values": {"angle": np.pi / 2, "axis": [0, 0, 2]}}
    for mode in ("OBJECT", "EDIT"):
        mesh, _ = edited(turn | {"mode": mode})
        np.testing.assert_allclose(mesh.vertices[4:], np.roll(two_sheets().vertices[4:], -1, axis=0), atol=1e-9)
        scale = {"operator": "scale", "objects": ["Above ü"], "values": {"value": [2, 1, 1]}, "mode": mode}
        mesh, _ = edited(scale)
        np.testing.assert_allclose(mesh.vertices[4:], two_sheets().vertices[4:] * (2, 1, 1), atol=1e-9)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("chosen", [(True, False, False), (True, False, True)])
def test_contact_leaves_no_constrained_axis(mode, chosen):
    """A sheet under a tilted one: without constraint, it slides down and turns."""
    tilt = np.array([[0.8, 0, 0.6], [0, 1, 0.1], [-0.6, 0.1, 0.8]])
    vertices = np.vstack([2 * SHEET @ tilt.T + (1.5, 0, 0), 0.3 * SHEET + (-1, 0.2, 0.4)])
    mesh = checked_mesh(vertices, np.vstack([FACES, FACES + 4]), ("Below", "Above ü"), np.array([0, 0, 1, 1], np.int32))
    step = {"operator": "move", "objects": ["Above ü"], "values": {"value": [2, 0, 0]}, "mode": mode}
    free, _ = edited(step, mesh=mesh)
    step["values"]["constraint_axis"] = list(chosen)
    held, (report,) = edited(step, mesh=mesh)
    moved = np.abs(held.vertices - vertices)[4:].max(axis=0)
    assert report["rounds"] > 0 and moved[0] > 0.1
    assert (moved[~np.array(chosen)] < 1e-12).all() and np.abs(free.vertices - vertices)[4:, 1:].max() > 0.01
    assert len(stiv.find_intersections(held.vertices, held.triangles)) == 0


def test_constrained_rotations_and_scales_keep_their_centre_and_axes():
    wall = 4 * SHEET[:, [2, 0, 1]] + (0.6, 0, 0)
    vertices = np.vstack([wall, 0.5 * SHEET * (1, 0.4, 1) + (0, 0, 0.1)])
    mesh = checked_mesh(vertices, np.vstack([FACES, FACES + 4]), ("Below", "Above ü"), np.array([0, 0, 1, 1], np.int32))
    values = {"value": [2, 1.5, 1], "constraint_axis": [True, True, False]}
    scaled, (report,) = edited({"operator": "scale", "objects": ["Above ü"], "values": values}, mesh=mesh)
    assert report["rounds"] > 0 and np.array_equal(scaled.vertices[4:, 2], vertices[4:, 2])
    long = checked_mesh(
        np.vstack([wall, SHEET * (0.2, 0.9, 1) + (0, 0, 0.1)]), mesh.triangles, mesh.object_names, mesh.triangle_object
    )
    values = {"angle": 1.5, "axis": [0, 0, 1], "constraint_axis": [False, False, True]}
    for mode in ("OBJECT", "EDIT"):
        turned, (report,) = edited(
            {"operator": "rotate", "objects": ["Above ü"], "values": values, "mode": mode}, mesh=long
        )
        assert report["rounds"] > 0
        np.testing.assert_allclose(turned.vertices[4:, 2], 0.1, atol=1e-12)
        if mode == "OBJECT":
            np.testing.assert_allclose(turned.vertices[4:].mean(axis=0), [0, 0, 0.1], atol=1e-12)


@pytest.mark.parametrize(
    ("step", "message"),
    [
        (move(1, objects=["Nothing"]), 'edit 0 (move): there is no object "Nothing"; the objects are Below, Above ü'),
        (move(1, mode="EDIT", points=[4]), "has 4 points, so point 4 is out of range"),
        (move(1, settings={"colour": 1}), 'setting "colour": mesh files support separation'),
        (move(1, settings={"separation": "x"}), "is not a number"),
        (move(1, settings={"separation": True}), "is not a number"),
        (move(1, settings={"tight": 1}), "is not true or false"),
        (
            {"operator": "rotate", "objects": ["Below"], "values": {"angle": 1, "axis": [0, 0, 0]}},
            "axis: the zero vector has no direction",
        ),
        (
            {"operator": "repair", "objects": ["Below"]},
            "mesh files only support move, scale, rotate; run `stiv repair`",
        ),
    ],
)
def test_mismatched_input_is_named(step, message):
    with pytest.raises(stiv.InputError) as raised:
        edited(step)
    assert message in str(raised.value)


def test_a_start_that_intersects_is_refused():
    with pytest.raises(stiv.InputError, match=r"edit 0 \(move\)"):
        edited(move(1), mesh=two_sheets(0.0))


def test_a_vertex_of_two_objects_is_refused():
    mesh = two_sheets()
    triangles = mesh.triangles.copy()
    triangles[3, 0] = 0
    with pytest.raises(stiv.InputError, match="vertex 0: belongs to two objects"):
        edited(move(1), mesh=checked_mesh(mesh.vertices, triangles, mesh.object_names, mesh.triangle_object))


def test_the_command_writes_an_npz(tmp_path, capsys):
    scene, edits = tmp_path / "a.obj", tmp_path / "e.json"
    lines = [f"v {x} {y} {z}" for x, y, z in two_sheets().vertices.tolist()]
    scene.write_text("\n".join([*lines, "o Below", "f 1 2 3 4", "o Above ü", "f 5 6 7 8"]), encoding="utf-8")
    edits.write_text(json.dumps({"schema": "stiv-edits", "version": 1, "steps": [move(-1.5)]}))
    out = tmp_path / "out.npz"
    assert program.run(["replay", str(scene), str(edits), "-o", str(out)]) == 0, capsys.readouterr().err
    mesh = read_mesh(out)
    assert mesh.object_names == ("Below", "Above ü") and (mesh.vertices[4:, 2] > 0).all()
    assert program.run(["replay", str(scene), str(edits), "-o", str(tmp_path / "out.blend")]) == 2
    assert "cannot write this format" in capsys.readouterr().err
