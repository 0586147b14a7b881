# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv resolve` keeps the render free too: what its files render, at frames and between, by rational arithmetic."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier
from oracles import rational

from stiv.blender.animation import guard_choice
from stiv.blender.scene.animation_curves import channel_curves
from stiv.blender.scripts.blend_files import open_blend, save_blend
from stiv.command_line import program

LAST = 6


def key(ob: Any, path: str, first: Any, last: Any) -> None:
    """Straight from one value to another."""
    for frame, value in ((1, first), (LAST, last)):
        setattr(ob, path, value)
        ob.keyframe_insert(path, frame=frame)


def add_wall(**properties: Any) -> Any:
    return add_grid("Wall", 4, 4.0, (3, 0, 0), rotation_euler=(0, np.pi / 2, 0.2), **properties)


def bumpy_cube() -> Any:
    """Bumps appear as it is subdivided: 3 times in the render, once in the viewport."""
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", subdivision_type="SIMPLE", levels=1, render_levels=3)
    texture = bpy.data.textures.new("Bumps", "CLOUDS")
    texture.noise_scale = 0.4
    add_modifier(cube, "DISPLACE", texture=texture, strength=0.6)
    return cube


def smooth_cube() -> Any:
    """Smooth in the viewport, larger in the render, which has its corners."""
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=2, render_levels=0)
    return cube


def into_wall(ob: Any) -> Any:
    add_wall()
    key(ob, "location", (0, 0, 0), (5, 0.5, 0))
    key(ob, "rotation_euler", (0, 0, 0), (0.3, 0.5, 0.4))
    return ob


def hidden_wall() -> None:
    into_wall(add_cube("Cube"))
    bpy.data.objects["Wall"].hide_viewport = True


def switched() -> None:
    """The render alone has the modifier."""
    add_modifier(into_wall(add_cube("Cube")), "DISPLACE", strength=0.8, show_viewport=False)


def bending() -> None:
    """Changes its shape, and is subdivided in the render alone."""
    cube = into_wall(smooth_cube())
    cube.shape_key_add(name="Basis")
    for point in cube.shape_key_add(name="Wide").data:
        point.co *= 1.3
    key(cube.data.shape_keys.key_blocks["Wide"], "value", 0.0, 1.0)


SCENES = {
    "levels": lambda: into_wall(bumpy_cube()),
    "corners": lambda: into_wall(smooth_cube()),
    "hidden wall": hidden_wall,
    "switched": switched,
    "shape": bending,  # written without modifiers
}


def triangles(name: str) -> np.ndarray:
    """World positions of the triangles that Blender shows of an object, (t, 3, 3)."""
    shown = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
    data = shown.to_mesh()
    data.calc_loop_triangles()
    points = np.array([shown.matrix_world @ vertex.co for vertex in data.vertices], float)
    corners = points[np.array([list(t.vertices) for t in data.loop_triangles])]
    shown.to_mesh_clear()
    return corners


def meetings(path: Path) -> tuple[int, int]:
    """Poses at which a file's two objects meet, at its frames and on the straight ways between: shown, and rendered."""
    open_blend(path)
    shown = sum(map(meet, poses()))
    for ob in bpy.data.objects:
        ob.hide_viewport = ob.hide_render
        for modifier in ob.modifiers:
            modifier.show_viewport = modifier.show_render
            if modifier.type == "SUBSURF":
                modifier.levels = modifier.render_levels
    return shown, sum(map(meet, poses()))


def poses() -> Iterator[list[np.ndarray]]:
    """The triangles of each object at all frames and keys, and at three poses between each two."""
    curves = [curve for action in bpy.data.actions for curve in channel_curves(action)]
    keys = {point.co.x for curve in curves for point in curve.keyframe_points}
    before: list[np.ndarray] = []
    for time in sorted(keys | set(range(1, LAST + 1))):
        bpy.context.scene.frame_set(int(time), subframe=time % 1)
        present = [triangles(ob.name) for ob in bpy.context.view_layer.objects if ob.visible_get()]
        for share in (0.25, 0.5, 0.75) if before else ():
            yield [(1 - share) * one + share * other for one, other in zip(before, present, strict=True)]
        yield present
        before = present


def meet(shown: list[np.ndarray]) -> bool:
    if len(shown) < 2:
        return False
    one, two = shown
    low, high = np.maximum(one.min(1)[:, None], two.min(1)), np.minimum(one.max(1)[:, None], two.max(1))
    near = np.argwhere((low <= high).all(axis=2))
    return any(rational.triangles_intersect((0, 1, 2), (3, 4, 5), np.vstack([one[a], two[b]])) for a, b in near)


def run(folder: Path, *options: str) -> tuple[int, Path, Path]:
    """Saves and resolves the open scene: exit code, scene and output."""
    scene, out = folder / "scene.blend", folder / "out.blend"
    save_blend(scene)
    report = folder / "report.json"
    arguments = [str(scene), "--frames", f"1:{LAST}", "-o", str(out), "--report", str(report)]
    return program.run(["resolve", *arguments, *options]), scene, out


@pytest.mark.shared
@pytest.mark.parametrize("scene", SCENES)
def test_the_render_is_free_and_check_agrees(tmp_path: Path, scene: str) -> None:
    SCENES[scene]()
    code, source, out = run(tmp_path)
    assert code == 0
    assert meetings(source)[1] > 0
    assert json.loads((tmp_path / "report.json").read_text())["guard"] == "both"
    assert meetings(out) == (0, 0)
    assert program.run(["check", str(out), "--frames", f"1:{LAST}", "--render"]) == 0


def test_each_guard_keeps_its_own_evaluation_free(tmp_path: Path) -> None:
    SCENES["corners"]()
    code, source, out = run(tmp_path, "--guard", "viewport")
    assert code == 0
    guards = ("viewport", "render", "both", "auto")
    check = ["check", str(out), "--frames", f"1:{LAST}", "--guard"]
    assert [program.run([*check, guard]) for guard in guards] == [0, 4, 4, 4]
    assert program.run([*check, "viewport", "--render"]) == 2
    met = meetings(out)
    assert met[0] == 0 < met[1]
    open_blend(source)
    assert run(tmp_path, "--guard", "render")[0] == 0 == program.run([*check, "render"])
    assert meetings(out)[1] == 0


def hooked() -> None:
    """A vertex stays behind at an empty, in the render alone."""
    cube, hook = into_wall(add_cube("Cube")), add("Hook", None, (1, 1, 1))
    add_modifier(cube, "HOOK", object=hook, show_viewport=False).vertex_indices_set([7])


def only_rendered_shape() -> None:
    SCENES["shape"]()
    bpy.data.objects["Cube"].hide_viewport = True


def animated_levels() -> None:
    """From frame 4 on the viewport and the render are alike."""
    cube = into_wall(add_cube("Cube"))
    modifier = add_modifier(cube, "SUBSURF", subdivision_type="SIMPLE", levels=1, render_levels=1, show_viewport=False)
    key(modifier, "show_viewport", False, True)


def start_rendered() -> None:
    SCENES["corners"]()
    bpy.data.objects["Wall"].location.x = 0.95


REFUSED = [
    (hooked, 2, "Cube: moves differently when rendered; "),
    (only_rendered_shape, 2, "Cube: deforms and is only rendered; "),
    (animated_levels, 2, "Cube: is rendered differently at frame "),
    (start_rendered, 4, "only the render intersects; "),
]


@pytest.mark.parametrize("guard", ["viewport", "render", "both"])
def test_shapes_are_written_at_the_levels_of_their_guard(tmp_path: Path, guard: str) -> None:
    SCENES["shape"]()
    code, _, out = run(tmp_path, "--guard", guard)
    assert code == 0 and meetings(out) == (0, 0)
    cube = bpy.data.objects["Cube"]
    assert not cube.modifiers and len(cube.data.vertices) == (8 if guard == "render" else 98)
    assert len(cube.data.shape_keys.key_blocks) >= LAST


@pytest.mark.parametrize(("make", "expected", "said"), REFUSED)
def test_unsupported_evaluations_are_refused_by_name(
    tmp_path: Path, capsys: Any, make: Callable[[], None], expected: int, said: str
) -> None:
    make()
    code, _, out = run(tmp_path)
    captured = capsys.readouterr()
    assert code == expected and not out.exists()
    assert said in captured.err + captured.out and "--guard viewport" in captured.err + captured.out


@pytest.mark.usefixtures("registered")
def test_the_scenes_own_guard_applies_and_a_large_render_is_reported(
    tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    SCENES["corners"]()
    for choice in ("render", "auto"):
        bpy.context.scene.stiv.guard = choice
        code, source, _ = run(tmp_path)
        report = json.loads((tmp_path / "report.json").read_text())
        assert (code, report["guard"]) == (0, "render" if choice == "render" else "both")
        open_blend(source)
    monkeypatch.setattr(guard_choice, "checked_evaluations", lambda context: ("viewport",))
    assert run(tmp_path)[0] == 0
    assert json.loads((tmp_path / "report.json").read_text())["guard"] == "viewport"
    assert "the render is not guarded: too many triangles; use --guard both" in capsys.readouterr().out


@pytest.mark.shared
def test_entries_of_a_batch_have_their_guards(tmp_path: Path) -> None:
    SCENES["corners"]()
    save_blend(tmp_path / "moves.blend")
    cube = bpy.data.objects["Cube"]
    cube.animation_data_clear()
    cube.location, cube.rotation_euler = (2.05, 0, 0), (0, 0, 0)
    save_blend(tmp_path / "still.blend")
    entries = []
    for guard in ("viewport", "render", "both"):
        still, report = {"scene": "still.blend", "guard": guard}, f"resolved {guard}.json"
        moves = {"scene": "moves.blend", "frames": f"1:{LAST}", "report": report, "output": f"{guard}.blend"}
        entries.append({"name": f"check {guard}", "command": "check", **still})
        entries.append({"name": f"repair {guard}", "command": "repair", **still, "output": f"repaired {guard}.blend"})
        entries.append({"name": f"resolve {guard}", "command": "resolve", **moves, "guard": guard})
    job = tmp_path / "job.json"
    job.write_text(json.dumps({"schema": "stiv-batch", "version": 2, "entries": entries}), encoding="utf-8")
    assert program.run(["batch", str(job), "--workers", "1", "--report", str(tmp_path / "report.json")]) == 4
    said = {entry["name"]: entry for entry in json.loads((tmp_path / "report.json").read_text())["entries"]}
    for guard in ("viewport", "render", "both"):
        assert said[f"check {guard}"]["exit_code"] == (0 if guard == "viewport" else 4)
        assert ("no intersections" in said[f"repair {guard}"]["message"]) == (guard == "viewport")
        assert said[f"resolve {guard}"]["exit_code"] == 0
        assert json.loads((tmp_path / f"resolved {guard}.json").read_text())["guard"] == guard
        met = meetings(tmp_path / f"{guard}.blend")
        assert [bool(each) for each in met] == [guard == "render" and met[0] > 0, guard == "viewport"]
