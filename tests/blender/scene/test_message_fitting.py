# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages fit Blender's status bar: the longest names are shortened, short ones stay."""

import pytest

pytest.importorskip("bpy")

from stiv.blender.scene.message_fitting import MESSAGE_LENGTH, first_and_others, fit_message

LONGEST = 63  # characters of a name in Blender


def test_names_that_fit_stay() -> None:
    assert fit_message("{} cuts {}", "Suzanne", "Spot") == "Suzanne cuts Spot"
    assert fit_message("no part") == "no part"


def test_the_longest_names_are_shortened_until_the_message_is_full() -> None:
    message = fit_message("{} cuts {}, {} faces", "M" * LONGEST, "Spot", 629)
    assert len(message) == MESSAGE_LENGTH and message.startswith("MMM") and message.endswith("M… cuts Spot, 629 faces")
    both = fit_message("{} cuts {}", "M" * LONGEST, "N" * LONGEST)
    assert len(both) == MESSAGE_LENGTH and both.count("M") == both.count("N")


def test_a_translation_may_change_the_order_of_the_names() -> None:
    message = fit_message("{1}: {0}", "M" * LONGEST, "N" * LONGEST)
    assert len(message) == MESSAGE_LENGTH and message.startswith("NNN") and "…: MMM" in message


def test_a_name_keeps_its_first_letters_where_the_rest_is_too_long() -> None:
    assert fit_message("{}: " + "x" * 90, "Suzanne Sitting").startswith("Suzan…: xxx")


def test_braces_in_names_are_not_filled_in() -> None:
    assert fit_message("{} cuts {}", "{0}", "{}") == "{0} cuts {}"


def test_others_are_counted() -> None:
    assert first_and_others(["Lamp"]) == ("Lamp", "")
    assert first_and_others(["Lamp", "Sun", "Spot"]) == ("Lamp", " and 2 more")
