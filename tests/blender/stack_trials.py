# SPDX-License-Identifier: GPL-3.0-or-later
"""Trials of edits under modifier stacks: a piece is pushed against a body, and the results are tested exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from building import as_rendered, edit_mode, evaluated, meet, select, shift, snapshot, turn
from stacks import add_body, random_stack

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene

WAYS = ("whole", "deforming", "edit mode")
TO_CONTACT = 0.2  # of the 0.25 between each piece and the body
DEPTH = 0.75  # of the goal of the last edit


@dataclass(frozen=True)
class Outcome:
    """A trial's result.

    Attributes:
        verdict: "followed", "stuck" (before the first contact), "refused", "intersecting start", or "met".
        text: the message of a refusal, or the intersections.
    """

    verdict: str
    text: str = ""


def run_trial(make: Callable[[], Any], way: str, seed: int, edits: int) -> Outcome:
    """Push the piece that `make` adds down onto a body, in a number of edits with random sides and turns.

    Raises AssertionError if a refusal changes the scene, or if a written state is not accepted.
    """
    random = np.random.default_rng(seed)
    piece = make()
    add_body()
    open_piece(piece, way)
    before, start, is_clear = snapshot(), evaluated(piece), not check_scene(bpy.context).pairs
    try:
        edit = BlenderEdit.begin(bpy.context, settings_of(way), "move")
    except stiv.StartIntersectsError:
        assert snapshot() == before and check_scene(bpy.context).pairs
        return Outcome("intersecting start")
    except stiv.InputError as error:
        assert snapshot() == before
        return Outcome("refused", str(error))
    assert snapshot() == before
    for number in range(1, edits + 1):
        down = shift(*random.uniform(-0.1, 0.1, 2), -DEPTH * number / edits)
        edit.drag(down @ turn(0.1 * random.normal(), "XYZ"[number % 3]))
        report = edit.write()
        assert report.passed, report.message
    assert edit.settle().status != "cancelled"
    assert edit.write().passed
    assert len(bpy.data.scenes) == 1
    moved = (evaluated(piece) - start)[:, 2].min()
    bpy.ops.object.mode_set(mode="OBJECT")
    met = _met(is_clear)
    return Outcome("met", met) if met else Outcome("followed" if moved < -TO_CONTACT else "stuck", f"{moved:.2f}")


def run_random_trial(seed: int) -> tuple[Outcome, list[str]]:
    """A trial of a random combination of modifiers, deforming or in Edit Mode, and the types of these modifiers."""
    random = np.random.default_rng(seed)
    names: list[str] = []

    def make() -> Any:
        piece = random_stack(random)
        names.extend(modifier.type for modifier in piece.modifiers)
        return piece

    return run_trial(make, WAYS[1 + seed % 2], seed, 3), names


def settings_of(way: str) -> EditSettings:
    """The settings of a way to edit."""
    return EditSettings(object_response="slide" if way == "whole" else "deform", guard="both")


def open_piece(piece: Any, way: str) -> None:
    """Select the piece; in Edit Mode, the half of its vertices with the lower y."""
    if way != "edit mode" or piece.type == "FONT":
        select(piece)
        if way == "edit mode":
            bpy.ops.object.mode_set(mode="EDIT")
        return
    edit_mode(piece)
    if piece.type == "CURVE":
        bpy.ops.curve.select_all(action="SELECT")
        return
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    low = np.median([vertex.co.y for vertex in piece.data.vertices])
    piece.data.vertices.foreach_set("select", [bool(vertex.co.y <= low) for vertex in piece.data.vertices])
    bpy.ops.object.mode_set(mode="EDIT")


def _met(was_clear: bool) -> str:
    """Intersections in Object Mode or in the render, those with the body by rational arithmetic; "" for none.

    Pieces that intersected themselves at the start may do so at the end.
    """
    pieces = [ob.name for ob in bpy.context.scene.objects if ob.name.startswith("Piece")]
    for shown in ("Object Mode", "the render"):
        if shown == "the render":
            as_rendered()
        for name in pieces:
            if count := meet(name, "Body"):
                return f"{count} pairs in {shown}"
        if was_clear and check_scene(bpy.context).pairs:
            return f"intersections in {shown}"
    return ""
