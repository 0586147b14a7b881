# SPDX-License-Identifier: GPL-3.0-or-later
"""The shields in the header: a color and a sign for each state."""

from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from stiv_addon.guard import icons  # noqa: E402


@pytest.mark.parametrize(("state", "brightest"), [("guarded", [1]), ("partial", [0, 1]), ("intersecting", [0])])
def test_states_have_their_color_and_differ_without_it(state: str, brightest: Any) -> None:
    picture = icons.pixels(state)
    colour = picture[(picture[..., 3] > 0) & (picture[..., :3].min(axis=2) < 1)].mean(axis=0)
    assert set(np.flatnonzero(colour[:3] > 0.6)) == set(brightest)
    signs = [icons.pixels(other)[..., :3].min(axis=2) == 1 for other in icons.COLOURS if other != state]
    assert all((sign != (picture[..., :3].min(axis=2) == 1)).sum() > 100 for sign in signs)
    assert not picture[0, 0].any() and not picture[-1, -1].any()


def test_icons_are_made_at_first_use_and_freed() -> None:
    assert all(icons.icon(state) >= 0 for state in icons.COLOURS)  # 0 in background mode
    assert set(icons._previews) == set(icons.COLOURS)
    icons.remove()
    assert icons._previews is None
