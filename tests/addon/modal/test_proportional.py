# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from stiv_addon.modal.proportional import FALLOFFS, Proportional


def test_proportional_editing_is_off_where_it_is_not_available() -> None:
    assert not Proportional(False, True).active and not Proportional(False).toggled().on
    assert Proportional(True).toggled().active and not Proportional(True, True).toggled().active


def test_falloffs_are_cyclic() -> None:
    proportional, seen = Proportional(True, True), []
    for _ in FALLOFFS:
        seen.append(proportional.falloff)
        proportional = proportional.with_next_falloff()
    assert sorted(seen) == sorted(FALLOFFS) and proportional.falloff == seen[0]


def test_a_notch_up_and_one_down_cancel_out() -> None:
    size = Proportional(True, True, 2.0).resized("PAGE_UP").resized("WHEELUPMOUSE").size
    assert size == pytest.approx(2.0)
    assert Proportional(True, True, 2.0).resized("WHEELDOWNMOUSE").size > 2.0
