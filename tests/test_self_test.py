# SPDX-License-Identifier: GPL-3.0-or-later
"""The self-test gives the committed hashes for all vector targets and any number of runs."""

import pytest

import stiv
from stiv import _native


@pytest.mark.parametrize("target", _native.VectorTarget)
def test_hashes_are_those_committed(target):
    best = _native.best_vector_target()
    if target.value > best.value:
        pytest.skip(f"this processor has no {target.name}")
    _native.limit_vector_target(target)
    try:
        result = stiv.self_test()
    finally:
        _native.limit_vector_target(best)
    assert result.passed, result
    assert result.vectors == target.name
