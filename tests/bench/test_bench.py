# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring sessions: the same edits by other options, averages over edits with contacts, the paper's own figures."""

import json
import subprocess
import sys
import types
from collections.abc import Iterator
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import stiv
from benchmarks.sessions import large_scene, running, scaling, table1
from benchmarks.sessions.running import EditFigures, record, repeat
from benchmarks.sessions.table1 import PUBLISHED, row, shares, table_text
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated
from blend_fixtures.scenes.sessions.catalogue import table_sessions
from blend_fixtures.scenes.sessions.session import Session, Stage, moved, repeated, single, surface_of
from stiv.command_line import program

SCHEMA = Path(table1.__file__).with_name("result.schema.json")


def ball_onto_sheet() -> Stage:
    ball = icosphere(1, 0.5).moved((0.05, 0.02, 0.75))
    surface, start = surface_of({"Ball": ball, "Sheet": triangulated(grid(6, 6, 2, 2))}, {"Sheet": "fixed"})
    moves = np.arange(len(ball.vertices))
    deformation = stiv.concatenate([(stiv.identity(len(moves)), moves)], start)
    return Stage("ball", surface, deformation, ball.vertices, repeated(moved((0, 0, -0.1)), 4))


def session() -> Session:
    return Session("knot", 0, "A ball moved down onto a sheet", single(ball_onto_sheet))


def figures_of(**values: object) -> EditFigures:
    timings = dict.fromkeys(["deformation", "detection", "volumes", "response", "acceptance"], 1.0)
    plain = {"stage": "", "status": "corrected", "collisions": 0.0, "regions": 0, "iterations": 0, "processor": 1.0}
    rest = {"clock": 1.0, "energy": 0.0, "intersections": 0, "timings": {**timings, "total": 10.0}}
    return EditFigures(**{**plain, **rest, **values})


def test_repeated_edits_with_the_same_options_have_the_same_results():
    recorded, first = record(session(), {"threads": 1}, lambda note: None)
    again = repeat(recorded, stiv.EditOptions, {"threads": 1})
    assert len(first) == 4 and [f.touches for f in first] == [False, False, True, True]
    assert [f.energy for f in again] == [f.energy for f in first]
    assert [f.iterations for f in again] == [f.iterations for f in first]
    assert all(f.intersections == 0 for f in first)


def test_a_goal_is_counted_from_where_the_edit_before_ended():
    recorded, _ = record(session(), {"threads": 1}, lambda note: None)
    tasks = recorded[0].tasks
    for task in tasks:
        assert np.allclose(task.goal - task.start, (0, 0, -0.1))
    assert (tasks[3].start[:, 2].min() > 0) and (tasks[3].goal[:, 2].min() < 0)


def test_a_row_averages_over_edits_with_contacts_only():
    recorded, _ = record(session(), {"threads": 1}, lambda note: None)
    free, busy = figures_of(processor=100.0), figures_of(iterations=2, collisions=6.0, regions=3, energy=4.0)
    values = row("knot", "stiv", "many", 1, recorded, [free, busy, busy], [free, busy, busy])
    assert (values["edits"], values["edits_with_contacts"]) == (3, 2)
    assert (values["collisions"], values["regions"], values["iterations"]) == (6, 3, 2)
    assert (values["ms_per_edit"], values["ms_per_iteration"], values["energy"]) == (1000, 500, 4)


def test_shares_add_up_to_one():
    assert shares([figures_of(), figures_of()]) == pytest.approx(
        {"modeling": 0.1, "detection": 0.1, "response": 0.2, "acceptance": 0.1, "other": 0.5}
    )


def test_the_published_totals_are_iterations_times_their_time():
    """Table 1 gives 48.55 / 40.64 ms an iteration for the plant, and so on: a slip of the pen would show."""
    each = {"plant": (48.55, 40.64), "hare": (630.3, 524.0), "tree": (56.59, 56.81), "knot": (65.43, 57.39)}
    for name, expected in each.items():
        values = PUBLISHED[name]
        assert np.divide(values["ms_per_edit"], values["iterations"]) == pytest.approx(expected, rel=0.01)


@pytest.fixture
def small_scenes(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    library = types.SimpleNamespace(table_sessions=lambda: {"knot": session()})
    monkeypatch.setattr(table1, "catalogue", library)
    return None


def test_the_command_prints_the_table_and_writes_its_rows(small_scenes, tmp_path, capsys):
    path = tmp_path / "table1.json"
    code = program.run(["bench", "table1", "--scenes", "knot", "--threads", "1", "2", "--json", str(path)])
    assert code == 0
    result = json.loads(path.read_text())
    jsonschema.validate(result, json.loads(SCHEMA.read_text()))
    rows = result["rows"]
    kinds = [(r["preset"], r["constraints"], r["threads"]) for r in rows]
    assert kinds == [
        ("stiv", "many", 1),
        ("stiv", "one", 1),
        ("paper", "many", 1),
        ("paper", "one", 1),
        ("paper_frozen", "many", 1),
        ("stiv", "many", 2),
    ]
    assert {r["intersections"] for r in rows} == {0}
    assert "150 / 124" in capsys.readouterr().out


def test_one_kind_of_constraint_can_be_asked_for(small_scenes):
    rows = table1.table1(["knot"], [1], lambda note: None, ["many"])
    assert [(r["preset"], r["constraints"]) for r in rows] == [
        ("stiv", "many"),
        ("paper", "many"),
        ("paper_frozen", "many"),
    ]


def test_a_row_that_intersects_ends_the_command_with_4(small_scenes, monkeypatch):
    monkeypatch.setattr(stiv, "find_intersections", lambda *_: [(0, 1)])
    assert program.run(["bench", "table1", "--scenes", "knot", "--threads", "1"]) == 4


def test_a_scene_that_is_not_there_ends_with_2(capsys):
    assert program.run(["bench", "table1", "--scenes", "bunny"]) == 2
    assert "there is no scene bunny" in capsys.readouterr().err


def test_the_energy_of_the_method_as_published_is_the_unit(small_scenes):
    rows = table1.table1(["knot"], [1], lambda note: None)
    line = next(line for line in table_text(rows).splitlines() if "its method here" in line)
    assert "1.000" in line


def test_the_exponent_of_a_power_law_is_found():
    rows = [{"triangles": n, "ms": 3 * n**1.25} for n in (10, 76, 300, 1200)]
    assert scaling.exponent(rows, "ms") == pytest.approx(1.25)


def test_a_step_is_measured_in_diagonals_of_the_moving_vertices():
    start = np.array([[0, 0, 0], [3, 4, 0], [90, 0, 0]], float)
    assert running.step_size(start, start + [[0.5, 0, 0], [0.1, 0, 0], [0, 0, 0]]) == pytest.approx(0.1)
    assert running.step_size(start, start) == 0


@pytest.mark.parametrize("name", ["tree", "knot"])
def test_the_tables_sessions_meet_at_least_the_papers_contacts_a_round(name):
    """Table 1 prints 16.16 and 23.25; the small moves of the figures' sessions make 7.0 and 5.3."""
    recorded, figures = record(table_sessions()[name], {"threads": 1}, lambda note: None)
    values = row(name, "stiv", "many", 1, recorded, figures, figures)
    assert values["collisions"] >= PUBLISHED[name]["collisions"]
    assert values["intersections"] == 0 and values["step"] > 0.005


def test_outside_a_checkout_the_command_says_where_the_measurements_are(tmp_path):
    command = [sys.executable, "-m", "stiv.command_line", "bench", "table1", "--json", "table1.json"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 2 and "run `stiv bench` in a source checkout" in run.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="resident memory is read from /proc")
def test_a_drag_over_a_landscape_is_measured_beside_it_and_with_it(monkeypatch):
    monkeypatch.setattr(large_scene, "SIZES", (800,))
    monkeypatch.setattr(large_scene, "TICKS", 60)
    monkeypatch.setattr(large_scene, "CUTS", 6)
    rows = large_scene.large_scene([1], 1000, lambda note: None)
    assert [r["scene"] for r in rows] == ["landscape as obstacle", "landscape as body"]
    assert all(r["static_triangles"] == 800 and r["ticks_with_contacts"] > 0 for r in rows)
    assert {r["intersections"] for r in rows} == {0}
    assert "obstacle" in large_scene.large_scene_text(rows)
