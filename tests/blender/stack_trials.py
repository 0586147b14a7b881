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
        verdict: "followed", "stuck" (before the first contact), "held" (the same, but the piece intersects itself at
            the start, and these pairs may not grow), "refused", "intersecting start", or "met".
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
    controls = edit.controls
    for number in range(1, edits + 1):
        down = shift(*random.uniform(-0.1, 0.1, 2), -DEPTH * number / edits)
        edit.drag(down @ turn(0.1 * random.normal(), "XYZ"[number % 3]))
        report = edit.write()
        assert report.passed, report.message
    settled = edit.settle()
    assert settled.status != "cancelled"
    assert edit.write().passed
    assert len(bpy.data.scenes) == 1
    moved = (evaluated(piece) - start)[:, 2].min()
    if way != "whole":  # a Curve modifier turns a motion down into another one
        moved = min(moved, (edit.controls - controls)[:, 2].min())
    bpy.ops.object.mode_set(mode="OBJECT")
    met = _met(is_clear)
    is_followed = moved < -TO_CONTACT or settled.status in ("reached", "unchanged")
    verdict = "followed" if is_followed else "stuck" if is_clear else "held"
    return Outcome("met", met) if met else Outcome(verdict, f"{moved:.2f}")


def kept_motion(make: Callable[[], Any], way: str) -> tuple[float, float]:
    """The fraction of a motion down that an edit keeps, and that of Blender's own Move up to the first intersection.

    Zero, twice, if the edit is refused, or the start intersects.
    """
    piece = make()
    add_body()
    if check_scene(bpy.context).pairs:
        return 0.0, 0.0
    open_piece(piece, way)
    down = np.array([0.0, 0.0, -DEPTH])
    start, selected = _placed(piece, way)
    try:
        edit = BlenderEdit.begin(bpy.context, settings_of(way), "move")
    except (stiv.InputError, stiv.StartIntersectsError):
        return 0.0, 0.0
    for number in range(1, 7):
        edit.drag(shift(*down * number / 6))
        assert edit.write().passed
    edit.settle()
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    moved = (_placed(piece, way)[0] - start)[selected]
    first = next((number for number in range(1, 17) if _touches(piece, way, start, selected, number / 16)), 17)
    low, high = (first - 1) / 16, first / 16
    while high - low > 0.01:
        middle = (low + high) / 2
        low, high = (low, middle) if _touches(piece, way, start, selected, middle) else (middle, high)
    return float((moved @ down).mean() / (down @ down)), min(low, 1.0)


def _placed(piece: Any, way: str) -> tuple[np.ndarray, np.ndarray]:
    """The moved positions: the object's location, or the local positions of its vertices; and flags of these."""
    piece.update_from_editmode()
    if way == "whole":
        return np.array([piece.location]), np.array([True])
    vertices = piece.data.vertices
    flags = [way != "edit mode" or vertex.select for vertex in vertices]
    return np.array([vertex.co for vertex in vertices]), np.array(flags)


def _touches(piece: Any, way: str, start: np.ndarray, selected: np.ndarray, fraction: float) -> bool:
    """Does anything intersect after Blender's own Move by a fraction of the motion down?"""
    positions = start + fraction * selected[:, None] * [0.0, 0.0, -DEPTH]
    if way == "whole":
        piece.location = positions[0]
    else:
        piece.data.vertices.foreach_set("co", positions.astype(np.float32).ravel())
        piece.data.update()
    hidden = [each for each in piece.modifiers if way == "edit mode" and not each.show_in_editmode]
    for is_shown in (True, False) if hidden else (True,):  # in Object Mode, and as Edit Mode shows it
        for modifier in hidden:
            modifier.show_viewport = is_shown
        bpy.context.view_layer.update()
        if meet(piece.name, "Body") or check_scene(bpy.context).pairs:
            return True
    return False


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
