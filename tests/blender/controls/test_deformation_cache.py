# SPDX-License-Identifier: GPL-3.0-or-later
from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("bpy")

from stiv.blender.controls import deformation_cache
from stiv.blender.controls.deformation_cache import MOST, forget_all, remembered

POINTS = np.arange(6.0).reshape(2, 3)


@pytest.fixture(autouse=True)
def nothing_kept() -> Iterator[None]:
    forget_all()
    yield
    forget_all()


def made(*inputs: object) -> object:
    made.calls += 1
    return object()


made.calls = 0


def test_equal_inputs_give_the_same_again() -> None:
    first = remembered(made, POINTS, 2, "name", None)
    assert remembered(made, POINTS.copy(), 2, "name", None) is first


@pytest.mark.parametrize(
    "inputs",
    [
        (np.nextafter(POINTS, 9.0), 2),
        (POINTS.reshape(3, 2), 2),
        (POINTS.astype(np.float32), 2),
        (POINTS, 3),
        (POINTS, "2"),
        (POINTS,),
        (2, POINTS),
    ],
)
def test_any_difference_makes_it_anew(inputs: tuple) -> None:
    first = remembered(made, POINTS, 2)
    assert remembered(made, *inputs) is not first
    before = made.calls
    remembered(made, *inputs)
    assert made.calls == before


def test_another_maker_is_another_thing() -> None:
    assert remembered(made, 1) is not remembered(lambda *inputs: object(), 1)


def test_old_ones_are_forgotten() -> None:
    first = remembered(made, 0)
    for number in range(1, MOST + 1):
        remembered(made, number)
    assert len(deformation_cache._kept) == MOST
    assert remembered(made, 0) is not first
