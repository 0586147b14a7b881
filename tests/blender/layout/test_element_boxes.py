# SPDX-License-Identifier: GPL-3.0-or-later
"""The search of boxes by blocks, against a comparison of each box."""

import numpy as np
import pytest

from stiv.blender.layout.element_boxes import BLOCK, ElementBoxes


def touching(positions: np.ndarray, elements: np.ndarray, box: np.ndarray) -> list[int]:
    return [
        number
        for number, corners in enumerate(positions[elements])
        if (corners.min(axis=0) <= box[1]).all() and (corners.max(axis=0) >= box[0]).all()
    ]


@pytest.mark.parametrize("count", [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 7 * BLOCK + 3])
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_exactly_the_touching_elements_are_found_at_rest_and_after_motion(count: int, share: float) -> None:
    chance = np.random.default_rng(count)
    positions = chance.integers(0, 9, (3 * count, 3)).astype(float)  # integers: many boxes touch exactly
    elements = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
    moves = chance.random(count) < share
    boxes = ElementBoxes(positions, elements, moves)
    for _ in range(3):
        for _ in range(10):
            low = chance.integers(-2, 9, 3)
            box = np.stack([low, low + chance.integers(0, 5, 3)]).astype(float)
            assert boxes.touching(box).tolist() == touching(positions, elements, box)
        rows = np.flatnonzero(moves)
        positions[elements[rows]] += chance.integers(-4, 5, (len(rows), 3, 3))
        boxes.update(positions, rows)
