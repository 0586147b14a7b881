# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from stiv.blender.scene.arrays import invert


@pytest.mark.parametrize("size", [3, 4])
def test_inverses_have_the_bits_of_numpy_and_cannot_be_changed(size: int) -> None:
    matrix = np.random.default_rng(size).normal(size=(size, size))
    for each in (matrix, matrix, np.asfortranarray(matrix)):
        assert (invert(each) == np.linalg.inv(matrix)).all()
    with pytest.raises(ValueError, match="read-only"):
        invert(matrix)[0, 0] = 1.0


def test_a_singular_matrix_has_no_inverse() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        invert(np.zeros((3, 3)))
