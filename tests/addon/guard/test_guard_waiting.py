# SPDX-License-Identifier: GPL-3.0-or-later
"""A long correction of the live guard: it runs in turns of the timer, and can be stopped."""

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from guarding import FURTHEST, box, expect_free, look, move, names_of_steps, watched_scene  # noqa: E402

import stiv_addon  # noqa: E402
from stiv.job import Job  # noqa: E402
from stiv_addon.guard import watcher  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(watcher, "FIRST_WAIT", 0.0)
    monkeypatch.setattr(watcher, "WAIT", 0.0)
    monkeypatch.setattr(Job, "wait", too_early(Job.wait))
    yield from watched_scene()


def too_early(wait: Callable[[Job[Any], float], bool]) -> Callable[[Job[Any], float], bool]:
    """A job's wait that never ends at the first three looks, however long another program holds this thread."""
    looks: Counter[Job[Any]] = Counter()

    def look_at(job: Job[Any], seconds: float) -> bool:
        looks[job] += 1
        return looks[job] > 3 and wait(job, seconds)

    return look_at


def long_correction() -> Any:
    """A correction after its first turns."""
    bpy.ops.transform.translate("EXEC_DEFAULT", True, value=(7.0, 0.4, 0.0))
    while watcher._watch.correction is None:
        assert watcher.observe_and_act() is not None
    return watcher._watch.correction.work


def test_a_correction_takes_turns_and_writes_the_tools_step() -> None:
    long_correction()
    turns = 0
    while watcher.observe_and_act() is not None:
        turns += 1
        assert names_of_steps() == ["start", "Move"]
    assert turns > 1 and box().location.x == pytest.approx(FURTHEST, abs=0.02)
    assert names_of_steps() == ["start", "Move"] and watcher._watch.correction is None and not watcher._watch.working
    expect_free()


@pytest.mark.shared
def test_a_stopped_correction_restores_the_state_before_the_tool_exactly() -> None:
    before = tuple(box().location)
    work = long_correction()
    for _ in range(3):
        watcher.observe_and_act()
    work.stopped = True
    look()
    assert tuple(box().location) == before and watcher.problem() is None
    assert names_of_steps() == ["start", "Move"]
    bpy.ops.ed.undo()
    look()
    bpy.ops.ed.redo()
    look()
    assert tuple(box().location) == before
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_a_copy_whose_correction_is_stopped_stays_and_is_named() -> None:
    bpy.ops.object.duplicate_move("EXEC_DEFAULT", True, TRANSFORM_OT_translate={"value": (2.2, 0.0, 0.0)})
    while watcher._watch.correction is None:
        watcher.observe_and_act()
    watcher._watch.correction.work.stopped = True
    look()
    assert bpy.data.objects["Box.001"].location.x == pytest.approx(2.2)
    assert watcher.problem().names == ["Box.001", "Wall"]


@pytest.mark.parametrize("end", [lambda: setattr(bpy.context.scene.stiv, "live_guard", False), stiv_addon.unregister])
def test_a_guard_that_is_turned_off_leaves_the_tools_result(end: Any) -> None:
    long_correction()
    end()
    try:
        assert tuple(box().location) == pytest.approx((7.0, 0.4, 0.0))
        assert not bpy.app.timers.is_registered(watcher.observe_and_act)
    finally:
        if end is stiv_addon.unregister:
            stiv_addon.register()
