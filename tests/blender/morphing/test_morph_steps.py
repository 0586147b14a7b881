# SPDX-License-Identifier: GPL-3.0-or-later
"""Morphs in steps, with jobs: the same results, only tested values between the steps, and an exact start after Esc."""

from __future__ import annotations

import threading
from typing import Any

import bpy
import numpy as np
import pytest
from building import evaluated
from test_morph import SETTINGS, add_key, add_shirt, ball_and_wall, check_stopped, scaled, widest

import stiv
from stiv.blender import EditSettings, Handles, MorphTask, Task, check_scene, morph
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.references import SceneChangedError
from tests.stepping import take_steps

GOALS = {"Ball": {"Wide": 1.0, "Tall": 0.5}}


def two_keys() -> Any:
    ball = ball_and_wall()
    add_key(ball, "Wide", scaled(3))
    add_key(ball, "Tall", scaled(z=2), value=0.125)
    bpy.context.view_layer.update()
    return ball


def dressed(kind: str) -> tuple[Any, EditSettings]:
    """A ball in a shirt that yields."""
    ball = ball_and_wall(5.0)
    add_key(ball, "Wide", scaled(1.6, 1.2))
    shirt = add_shirt()
    shirt.vertex_groups.new(name="Grip").add(list(range(0, len(shirt.data.vertices), 3)), 1.0, "REPLACE")
    handles = {"Shirt": Handles(groups=("Grip",))} if kind == "arap" else {}
    return shirt, EditSettings(separation=0.01, responders="unselected", deformations={"Shirt": kind}, handles=handles)


def values(ob: Any) -> list[float]:
    return [block.value for block in ob.data.shape_keys.key_blocks]


def test_steps_end_as_one_call_does_and_show_nothing_in_between() -> None:
    ball = two_keys()
    start = values(ball)
    morphing = MorphTask(bpy.context, GOALS, SETTINGS)
    task, shown = Task(morphing.solve_steps()), []
    while not take_steps(task, 1):
        morphing.write_tested()
        shown.append(values(ball))
    assert len(shown) > 20 and all(each == start for each in shown)
    in_steps = values(ball)
    check_stopped(ball)
    morphing.restore()
    assert values(ball) == start
    assert morph(bpy.context, GOALS, SETTINGS) == task.result
    assert values(ball) == in_steps != start


@pytest.mark.shared
@pytest.mark.parametrize("kind", ["vertices", "arap"])
def test_clothes_in_steps_end_as_in_one_call(kind: str) -> None:
    shirt, settings = dressed(kind)
    before = evaluated(shirt)
    morphing = MorphTask(bpy.context, {"Ball": {"Wide": 1.0}}, settings)
    task = Task(morphing.solve_steps())
    while not take_steps(task, 1):
        morphing.write_tested()
        assert np.array_equal(evaluated(shirt), before)
    in_steps = evaluated(shirt)
    assert widest(shirt) > before[:, 0].max() + 0.2 and check_scene(bpy.context).pairs == ()
    morphing.restore()
    assert np.array_equal(evaluated(shirt), before)
    assert morph(bpy.context, {"Ball": {"Wide": 1.0}}, settings) == task.result
    assert np.array_equal(evaluated(shirt), in_steps)


def test_blender_is_written_in_the_thread_that_advances(monkeypatch: pytest.MonkeyPatch) -> None:
    threads, write = set(), MorphedScene.write

    def noted(scene: MorphedScene, controls: Any) -> None:
        threads.add(threading.get_ident())
        write(scene, controls)

    monkeypatch.setattr(MorphedScene, "write", noted)
    two_keys()
    task = Task(MorphTask(bpy.context, GOALS, SETTINGS).solve_steps())
    while not task.advance(0.01):
        pass
    assert threads == {threading.get_ident()}


@pytest.mark.parametrize("ends", ["abandon", "cancel", "restore"])
def test_a_morph_that_ends_early_leaves_the_start(ends: str) -> None:
    """After any number of steps: while the scene is read, while a job solves, and between jobs."""
    ball = two_keys()
    start, shape = values(ball), evaluated(ball)
    for steps in (0, 1, 2, 3, 5, 8, 13, 21, 34):
        morphing = MorphTask(bpy.context, GOALS, SETTINGS)
        task = Task(morphing.solve_steps())
        assert not take_steps(task, steps), "the morph takes more steps"
        if ends == "cancel":
            task.cancel()
            with pytest.raises(stiv.CancelledError):
                while not task.advance(0.01):
                    pass
        else:
            task.abandon()
        if ends == "restore":
            morphing.restore()
        assert values(ball) == start and np.array_equal(evaluated(ball), shape), steps


def test_an_object_that_is_gone_ends_the_morph_with_an_error() -> None:
    """Whenever a script deletes it."""
    for steps in (1, 3, 10, 30):
        ball = two_keys()
        morphing = MorphTask(bpy.context, GOALS, SETTINGS)
        task = Task(morphing.solve_steps())
        assert not take_steps(task, steps)
        bpy.data.objects.remove(ball)
        with pytest.raises((stiv.InputError, SceneChangedError)):
            while not task.advance(0.01):
                morphing.write_tested()
        bpy.data.objects.remove(bpy.data.objects["Wall"])
