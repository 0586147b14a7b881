# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices without Blender: properties of all interpolation types."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stiv

INTERPOLATIONS = ("linear", "cardinal", "catmull_rom", "bspline")
RANDOM = np.random.default_rng(1)
VERTICES = RANDOM.normal(scale=2.0, size=(50, 3))


@given(
    st.lists(st.integers(1, 6), min_size=3, max_size=3),
    st.lists(st.sampled_from(INTERPOLATIONS), min_size=3, max_size=3),
    st.integers(-3, 12),
)
def test_weights_add_up_to_one(resolution: list[int], interpolation: list[str], decades: int) -> None:
    weights = stiv.lattice_weights(VERTICES * 10.0**decades, resolution, interpolation=interpolation)
    assert weights.shape == (50, np.prod(resolution))
    assert np.abs(weights.dense().sum(axis=1) - 1).max() < 1e-12


@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
def test_linear_motion_inside_is_reproduced(interpolation: str) -> None:
    """Points moved by an affine map move what is two cells inside by the same one."""
    inside = RANDOM.uniform(-1.5, 1.5, size=(30, 3))
    rest = stiv.lattice_rest_points((7, 7, 7))
    deformation = stiv.lattice(inside, (7, 7, 7), interpolation=interpolation)
    matrix, shift = np.eye(3) + RANDOM.normal(scale=0.3, size=(3, 3)), RANDOM.normal(size=3)
    found = deformation.surface(rest @ matrix.T + shift)
    # Cardinal splines with a tension other than 1/2 do not reproduce straight lines; they do reproduce
    # shifts.
    if interpolation == "cardinal":
        found, matrix = deformation.surface(rest + shift), np.eye(3)
    assert np.abs(found - (inside @ matrix.T + shift)).max() < 1e-12


def test_splines_pass_through_the_points() -> None:
    rest = stiv.lattice_rest_points((3, 4, 5))
    moved = rest + RANDOM.normal(size=rest.shape)
    for interpolation in ("linear", "cardinal", "catmull_rom"):
        found = stiv.lattice(rest, (3, 4, 5), interpolation=interpolation).surface(moved)
        assert np.abs(found - moved).max() < 1e-12


@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
def test_weights_are_continuous(interpolation: str) -> None:
    """Across the planes of points, and across the ends."""
    for plane in (-1.5, -0.5, 0.5, 1.5, 2.5, -2.5):
        near = [
            stiv.lattice_weights([[plane + d, 0.2, 0.3]], (4, 4, 4), interpolation=interpolation).dense()
            for d in (-1e-9, 1e-9)
        ]
        assert np.abs(near[0] - near[1]).max() < 1e-7


def test_frame_and_rest_positions() -> None:
    frame = np.array([[0, -2, 0, 1], [3, 0, 0, 2], [0, 0.2, -1, 3], [0, 0, 0, 1.0]])
    rest = stiv.lattice_rest_points((4, 4, 4))
    world_rest = rest @ frame[:3, :3].T + frame[:3, 3]
    deformation = stiv.lattice(VERTICES, (4, 4, 4), frame=frame)
    assert np.abs(deformation.surface(world_rest) - VERTICES).max() < 1e-13
    # The same lattice with its frame's scale moved into the rest positions.
    scaled = stiv.lattice(VERTICES, (4, 4, 4), frame=frame @ np.diag([0.5, 0.25, 2, 1]), rest=rest / [0.5, 0.25, 2])
    moved = world_rest + RANDOM.normal(size=world_rest.shape)
    assert np.abs(deformation.surface(moved) - scaled.surface(moved)).max() < 1e-12


def test_influence_scales_the_motion() -> None:
    rest = stiv.lattice_rest_points((4, 4, 4))
    moved = rest + RANDOM.normal(size=rest.shape)
    full = stiv.lattice(VERTICES, (4, 4, 4)).surface(moved) - VERTICES
    half = stiv.lattice(VERTICES, (4, 4, 4), influence=0.5).surface(moved) - VERTICES
    assert np.abs(half - 0.5 * full).max() < 1e-12
    squared = stiv.lattice(VERTICES, (4, 4, 4), influence=0.5, point_weights=np.ones(64)).surface(moved) - VERTICES
    assert np.abs(squared - 0.25 * full).max() < 1e-12


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"resolution": (4, 0, 4)}, "resolution"),
        ({"resolution": (4, 4)}, "resolution"),
        ({"interpolation": "cubic"}, 'interpolation "cubic"'),
        ({"rest": np.zeros((64, 3))}, "coincide along axis 0"),
        ({"rest": np.zeros((63, 3))}, "63 rest positions for 64"),
        ({"point_weights": np.ones(5)}, "5 point weights for 64"),
        ({"influence": np.ones(5)}, "influence: shape"),
        ({"vertices": [[0, np.nan, 0]]}, "vertices, row 0"),
        ({"frame": np.zeros((4, 4))}, "frame: the matrix is singular"),
    ],
)
def test_bad_input_is_named(options: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"vertices": VERTICES, "resolution": (4, 4, 4), **options}
    with pytest.raises(stiv.InputError, match=message):
        stiv.lattice(**arguments)
