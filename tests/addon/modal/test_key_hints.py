# SPDX-License-Identifier: GPL-3.0-or-later
"""The keys in the status bar: Blender's icons, every word translated, none cut off."""

from dataclasses import replace

import pytest

from stiv_addon.modal.key_hints import CANCEL, CONFIRM, KeyHint, hints_that_fit, key_hints, stop_hints
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.proportional import Proportional
from stiv_addon.modal.state import State
from stiv_addon.modal.typed_numbers import TypedValues

PLAIN = State(Pointer.at((0.0, 0.0), None))
STATES = {
    "plain": PLAIN,
    "proportional": replace(PLAIN, proportional=Proportional(available=True, on=True)),
    "typing": replace(PLAIN, typed=TypedValues().typed("1")),
    "expression": replace(PLAIN, typed=TypedValues().as_expression().typed("1")),
}


@pytest.mark.parametrize("name", STATES)
def test_confirm_and_cancel_come_first_and_every_word_is_translated(name: str) -> None:
    hints = key_hints(STATES[name])
    assert [hint.label for hint in hints[:2]] == ["Confirm", "Cancel"]
    assert [hint.label for hint in key_hints(STATES[name], str.upper)] == [hint.label.upper() for hint in hints]
    assert len({hint.icons for hint in hints}) == len(hints)


def test_only_keys_that_have_an_effect_are_named() -> None:
    labels = {name: {hint.label for hint in key_hints(state)} for name, state in STATES.items()}
    assert "Falloff" in labels["proportional"] - labels["plain"]
    assert "Expression" in labels["typing"] - labels["expression"]
    assert not labels["typing"] & {"Snap", "Transform"}
    assert [hint.icons for hint in stop_hints()] == [("EVENT_ESC",)]


def test_the_least_important_keys_are_left_out_where_the_window_is_narrow() -> None:
    hints = [KeyHint(CONFIRM, "Confirm"), KeyHint(CANCEL, "Cancel"), KeyHint(("EVENT_I",), "Collisions")]
    assert hints_that_fit(hints, 250.0, lambda hint: 100.0) == hints[:2]
    assert hints_that_fit(hints, 300.0, lambda hint: 100.0) == hints


def test_every_icon_exists_in_blender() -> None:
    bpy = pytest.importorskip("bpy")
    known = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys()
    hints = [hint for state in STATES.values() for hint in key_hints(state)] + stop_hints()
    assert {icon for hint in hints for icon in hint.icons} <= set(known)
