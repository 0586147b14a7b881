# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames as dragged: a script is dragged to its end, every tick is reported, and the result is free."""

from dataclasses import replace
from pathlib import Path

import bpy
import pytest

import stiv
from benchmarks.sessions.dragged_profile import (
    dragged_rows,
    dragged_text,
    frames_missed,
    shapes_a_second,
    shown_apart,
)
from benchmarks.sessions.in_blender import drags_in_blender
from stiv.blender.scripts.blend_files import open_blend
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.edit_scripts import EditScript, EditStep, read_edit_script

FIXTURES = Path(__file__).resolve().parents[2] / "blend_fixtures"
BLEND = FIXTURES / "sphere_along_wall.blend"


def test_every_drag_of_a_script_is_reported_tick_by_tick():
    open_blend(BLEND)
    before = read_surface(bpy.context).positions
    (row,), failed = dragged_rows(BLEND, drags_in_blender, [1])
    script = read_edit_script(BLEND.with_suffix(".edits.json"))
    assert failed == 0 and row["threads"] == 1 and len(row["stages"]) == len(script.steps)
    assert abs(read_surface(bpy.context).positions - before).max() > 0.05
    assert find_pairs(read_surface(bpy.context)) == ()
    for stage in row["stages"]:
        ticks = stage["ticks"]
        assert len({len(values) for values in ticks.values()}) == 1 and any(ticks["shown"])
        assert sorted(ticks["at"]) == ticks["at"]
        assert min(ticks["solving"]) >= 0
        assert all(behind >= whole for behind, whole, shown in zip(
            ticks["behind"], ticks["seconds"], ticks["shown"], strict=True) if shown)  # fmt: skip
        assert (shown_apart(stage) > 0).all()
        assert all(rate > 0 for rate in shapes_a_second(stage)) and frames_missed(stage) >= 0
    assert dragged_text([{"scene": "sphere", "dragged": [row]}]).splitlines()[1].startswith("sphere")


def test_shapes_are_counted_over_the_worst_second_and_missed_frames_in_a_row():
    at = [*(k / 60 for k in range(1, 61)), *(1 + k / 20 for k in range(1, 21))]
    ticks = {"at": at, "shown": [True] * len(at)}
    stage = {"moving": 2.0, "settling": 0.0, "ticks": ticks}
    assert shapes_a_second(stage) == (pytest.approx(20), pytest.approx(60))
    assert frames_missed(stage) == 2 and frames_missed({**stage, "moving": 2.5}) == 29


@pytest.mark.usefixtures("registered")
def test_rotations_are_refused():
    from benchmarks.sessions.dragged_frames import dragged_stages
    from stiv_addon.scene.edit_settings import edit_settings

    open_blend(BLEND)
    name = next(ob.name for ob in bpy.context.scene.objects if ob.type == "MESH")
    turned = EditStep("rotate", "OBJECT", (name,), {"angle": 1.0, "axis": (0, 0, 1)})
    with pytest.raises(stiv.InputError, match="rotate"):
        dragged_stages(EditScript((turned,)), lambda scene: replace(edit_settings(scene), threads=1), None)
