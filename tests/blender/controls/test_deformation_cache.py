# SPDX-License-Identifier: GPL-3.0-or-later
from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("bpy")

from stiv.blender.controls import deformation_cache
from stiv.blender.controls.deformation_cache import MAX_ENTRIES, cached_deformation, clear_cache

POINTS = np.arange(6.0).reshape(2, 3)


@pytest.fixture(autouse=True)
def nothing_kept() -> Iterator[None]:
    clear_cache()
    yield
    clear_cache()


def made(*inputs: object) -> object:
    made.calls += 1
    return object()


made.calls = 0


def test_equal_inputs_return_the_cached_deformation() -> None:
    first = cached_deformation(made, POINTS, 2, "name", None)
    assert cached_deformation(made, POINTS.copy(), 2, "name", None) is first


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
def test_different_inputs_make_a_new_deformation(inputs: tuple) -> None:
    first = cached_deformation(made, POINTS, 2)
    assert cached_deformation(made, *inputs) is not first
    before = made.calls
    cached_deformation(made, *inputs)
    assert made.calls == before


def test_different_functions_do_not_share_results() -> None:
    assert cached_deformation(made, 1) is not cached_deformation(lambda *inputs: object(), 1)


def test_the_oldest_deformations_are_removed() -> None:
    first = cached_deformation(made, 0)
    for number in range(1, MAX_ENTRIES + 1):
        cached_deformation(made, number)
    assert len(deformation_cache._cache) == MAX_ENTRIES
    assert cached_deformation(made, 0) is not first
