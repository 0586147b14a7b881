# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators and the live guard stop where a modifier would change the topology, and say so."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
sys.path.append(str(Path(__file__).resolve().parents[1] / "blender"))

from building import add_modifier, edit_mode, evaluated, select  # noqa: E402
from stacks import add_sheet  # noqa: E402

from stiv.blender import AcceptedScene  # noqa: E402
from stiv.task import run  # noqa: E402
from stiv_addon.guard import correction  # noqa: E402
from stiv_addon.operators import reports  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")
SAID = "blocked: the topology of Piece changes here; apply its modifiers"


@pytest.fixture(params=["OBJECT", "EDIT"])
def sheet(request: pytest.FixtureRequest) -> Any:
    """A sheet of 49 vertices that a Weld modifier merges where they come closer than 0.1."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    ob = add_sheet()
    ob.stiv.deformation = "vertices"
    add_modifier(ob, "WELD", merge_threshold=0.1)
    select(ob)
    if request.param == "EDIT":
        edit_mode(ob)
        bpy.ops.mesh.select_all(action="SELECT")
    return ob


def is_cut(ob: Any) -> bool:
    points = evaluated(ob)
    return len(points) == 49 and 0.6 < np.ptp(points[:, 0]) < 0.61


def test_an_operator_cuts_the_step(sheet: Any) -> None:
    bpy.ops.stiv.scale(value=(0.1, 0.1, 1.0))
    assert is_cut(sheet) and reports.last_messages[-1].endswith(SAID)


def test_the_guard_cuts_the_result_of_a_tool(sheet: Any) -> None:
    accepted = AcceptedScene.read(bpy.context)
    if sheet.mode == "EDIT":
        bpy.ops.transform.resize(value=(0.1, 0.1, 1.0))
    else:
        for vertex in sheet.data.vertices:
            vertex.co.xy *= 0.1
        sheet.data.update()
    bpy.context.view_layer.update()
    assert len(evaluated(sheet)) < 49
    outcome = run(correction.correct_steps(bpy.context, accepted))
    assert is_cut(sheet) and outcome.wrote and outcome.text == f"corrected Piece; {SAID}"
