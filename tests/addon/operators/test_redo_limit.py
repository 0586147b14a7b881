# SPDX-License-Identifier: GPL-3.0-or-later
"""The redo panel waits for a limited time: calls after it are cancelled, and their result stays."""

from typing import Any

import pytest

bpy = pytest.importorskip("bpy")

from stiv.task import Call, Steps  # noqa: E402
from stiv_addon.operators.transform import redo_limit  # noqa: E402


def one_call(most: int) -> Steps[int]:
    """A call that reports progress until it is cancelled, at most this many times; returns how many times it did."""

    def work(cancel: Any, progress: Any) -> int:
        for count in range(most):
            progress("round", count / most)
            if cancel.cancelled:
                return count
        return most

    return (yield Call(work, None))


@pytest.mark.parametrize(("limit", "expected"), [(-1.0, (0, True)), (1e9, (7, False))])
def test_calls_after_the_limit_are_cancelled(limit: float, expected: tuple[int, bool]) -> None:
    assert redo_limit.run_within(bpy.context, one_call(7), limit) == expected


def test_the_limit_of_the_redo_panel_is_not_that_of_scripts() -> None:
    class Operator:
        class options:  # noqa: N801 (Blender's name)
            is_repeat = True

    assert bpy.app.background and not redo_limit.is_redo(Operator)
