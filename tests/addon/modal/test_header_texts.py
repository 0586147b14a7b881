# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a drag: Blender's own texts, in any language, within the width of the view."""

import math
from dataclasses import replace

import numpy as np
import pytest

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.header_texts import SEPARATOR, fitted, fixed_text, header_parts, progress_text, result_text
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.proportional import Proportional
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.modal.typed_numbers import TypedValues
from stiv_addon.transform import Transform
from stiv_addon.transform.frame import Frame
from stiv_addon.transform.rotation import Rotation
from stiv_addon.transform.scaling import Scaling
from stiv_addon.transform.translation import Translation

PLAIN = State(Pointer.at((0.0, 0.0), None))
TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # the second orientation's X is the world's Y
FRAME = Frame(np.zeros(3), second_axes=TURNED)
NOISE = -2.656e-08
MOVED = Translation(np.array([4.344, 0.5, NOISE]))
ORIENTATIONS = ("GLOBAL", "LOCAL")


def metres(value: float) -> str:
    return f"{fixed_text(value)} m"


def line(transform: Transform, state: State) -> str:
    """The whole header for a transform that is clear."""
    return fitted(
        header_parts(state, transform.text(state, FRAME, length=metres), "", (), ORIENTATIONS), lambda _: True
    )


@pytest.mark.parametrize(
    ("transform", "lock", "expected"),
    [
        (MOVED, AxisLock(), "Dx: 4.344 m   Dy: 0.5000 m   Dz: 0.0000 m (4.373 m)"),
        (MOVED, AxisLock(0), "D: 4.344 m (4.373 m) along global X"),
        (MOVED, AxisLock(0, second=True), "D: 0.5000 m (4.373 m) along local X"),
        (MOVED, AxisLock(2, plane=True), "D: 4.344 m   D: 0.5000 m (4.373 m) locking global Z"),
        (Rotation(math.radians(17), np.eye(3)[2]), AxisLock(2), "Rotation: 17.00° along global Z"),
        (Rotation(math.radians(NOISE), np.eye(3)[2]), AxisLock(), "Rotation: 0.00°"),
        (Scaling(np.array([1.2, 1.2, 1.2])), AxisLock(), "Scale X: 1.2000   Y: 1.2000   Z: 1.2000"),
        (Scaling(np.array([1.2, 1.0, 1.0])), AxisLock(0), "Scale: 1.2000 along global X"),
        (Scaling(np.array([2.0, 3.0, 1.0])), AxisLock(2, plane=True), "Scale: 2.0000 : 3.0000 locking global Z"),
    ],
)
def test_values_are_written_as_in_the_headers_of_blender(transform: Transform, lock: AxisLock, expected: str) -> None:
    assert line(transform, replace(PLAIN, axis_lock=lock)) == expected


def test_typed_text_stands_before_its_value() -> None:
    typed = TypedValues().typed("5").moved_on(3).typed("-")
    state = replace(PLAIN, typed=typed)
    assert line(Translation(np.array([5.0, 0.0, 0.0])), state) == (
        "Dx: [5] = 5.000 m   Dy: [-|] = 0.0000 m   Dz: 0.0000 m (5.000 m)"
    )


@pytest.mark.parametrize(
    ("value", "expected"),
    [(NOISE, "0.0000"), (0.12345, "0.1235"), (4.3, "4.300"), (-12.344, "-12.34"), (1e6, "1000000"), (-0.5, "-0.5000")],
)
def test_numbers_have_a_fixed_number_of_digits_and_no_rounding_noise(value: float, expected: str) -> None:
    assert fixed_text(value) == expected


def test_the_header_names_modes_that_differ_from_the_defaults() -> None:
    proportional = Proportional(available=True, on=True, size=1.5, falloff="INVERSE_SQUARE", connected=True)
    state = replace(PLAIN, request=Request("move", "all"), precise=True, snap=frozenset({"move"}))
    state = replace(state, proportional=proportional)
    assert header_parts(state, "D", "clear", ["a note"]) == [
        "D", "clear", "Proportional Size: 1.50, Inverse Square, connected", "precision, snap, yields: both", "a note",
    ]  # fmt: skip


def test_parts_that_do_not_fit_are_left_out() -> None:
    parts = ["value", "blocked", "a mode", "a note"]
    assert fitted(parts, lambda _: True) == SEPARATOR.join(parts)
    assert fitted(parts, lambda text: len(text) <= 20) == "value  |  blocked"
    assert fitted(["value", "a long list of names", "a mode"], lambda text: len(text) <= 20) == "value  |  a mode"
    assert fitted(parts, lambda _: False) == "value"


def shout(text: str) -> str:
    """A language in which everything is written in capitals."""
    return text.upper()


def test_every_word_of_a_header_is_translated_and_names_of_objects_are_not() -> None:
    state = replace(PLAIN, precise=True, request=Request("move", "unselected"), axis_lock=AxisLock(0))
    status = result_text("blocked", ["Vase", "wall"], shout)
    value = Rotation(1.0, np.eye(3)[0]).text(state, FRAME, shout)
    assert header_parts(state, value, status, translate=shout) == [
        "ROTATION: 57.30° ALONG X", "BLOCKED BY Vase, wall", "PRECISION, YIELDS: OTHERS",
    ]  # fmt: skip


def test_an_unknown_status_is_shown_as_it_is_and_many_names_are_counted() -> None:
    assert result_text("unheard of") == "unheard of"
    assert result_text("unchanged") == ""
    assert result_text("blocked", ["a", "b", "c", "d", "e"]) == "blocked by a, b, c and 2 more"


def test_progress_says_how_to_stop() -> None:
    assert progress_text(0.43) == "Solving 43 %, Esc stops"
