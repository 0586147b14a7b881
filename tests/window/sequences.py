# SPDX-License-Identifier: GPL-3.0-or-later
"""Random events during drags: no event may cause a crash, an intersection or leftovers."""

from __future__ import annotations

import os
import random
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import bpy
import scenes
from playing import prepared
from simulation import Steps, Window

COUNT = int(os.environ.get("STIV_WINDOW_SEQUENCES", "200"))
FIRST = int(os.environ.get("STIV_WINDOW_FIRST_SEQUENCE", "0"))
EVENTS = 14  # of a sequence, at most
PATIENCE = 20.0  # seconds until a drag has begun
PAUSE = 0.004  # seconds between two of them
SCENES = (
    (scenes.add_box, "Box", "OBJECT"),
    (scenes.add_cage, "Cage", "EDIT"),
    (scenes.add_ball_in_lattice, "Lattice", "EDIT"),
)
KEYS = (
    *"GRSXYZWO",
    *("ZERO", "ONE", "TWO", "FIVE", "PERIOD", "MINUS", "SLASH", "EQUAL", "BACK_SPACE", "TAB"),
    *("PAGE_UP", "PAGE_DOWN", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "LEFT_CTRL", "LEFT_SHIFT", "F", "HOME"),
)
CONFIRMING = ("RET", "LEFTMOUSE")
MOST_SECONDS = 2.0  # after the last Esc
ENDS = (*CONFIRMING, "ESC", "RIGHTMOUSE")


class Sequence:
    """One sequence; the same number gives the same events."""

    def __init__(self, window: Window, number: int):
        """Choose by number."""
        self.window = window
        self.random = random.Random(number)
        self.scene = SCENES[number % len(SCENES)]
        self.disturbed = False
        self.log: list[str] = []

    def play(self) -> Steps:
        """Begin, disturb, end, look."""
        self.window.key("ESC")  # closes a message of the sequence before, which would swallow keys
        yield from self.window.settle(2)
        build, active, mode = self.scene
        yield from prepared_quickly(self.window, build, active, mode)
        before = self.state()
        self.window.key(self.random.choice("MRE"), shift=True, alt=True)
        deadline = time.monotonic() + PATIENCE
        while not self.window.dragging():
            assert time.monotonic() < deadline, "the drag did not begin"
            yield PAUSE
        for _ in range(self.random.randint(3, EVENTS)):
            self.act()
            yield PAUSE
            if not self.window.dragging():
                break
            self.expect_free("during the drag")
        ended_by = yield from self.end()
        self.expect_free("at the end")
        assert not self.window.leftovers(), self.described(self.window.leftovers())
        if ended_by in ("ESC", "RIGHTMOUSE") and not self.disturbed:
            assert self.state() == before, self.described("cancelling did not put everything back")

    def act(self) -> None:
        """One event, sometimes from outside the drag."""
        chance = self.random.random()
        if chance < 0.45:
            self.glance()
        elif chance < 0.93:
            self.press(self.random.choice(KEYS))
        else:
            self.disturb()

    def glance(self) -> None:
        """Move the mouse, anywhere in the view."""
        region = self.window.region
        x = region.x + self.random.randrange(region.width)
        y = region.y + self.random.randrange(region.height)
        self.log.append(f"mouse {x} {y}")
        self.window.move(x, y, shift=self.random.random() < 0.1, ctrl=self.random.random() < 0.1)

    def press(self, key: str) -> None:
        """A key, sometimes with Shift."""
        shift = self.random.random() < 0.2
        self.log.append(f"{'Shift+' if shift else ''}{key}")
        self.window.key(key, shift=shift)

    def disturb(self) -> None:
        """Other actions of a user or a script."""
        action = self.random.choice((self.undo_key, self.save, self.delete_wall, self.delete_dragged, self.leave_mode))
        self.log.append(action.__name__)
        action()

    def undo_key(self) -> None:
        """Ctrl+Z, which a drag ignores."""
        self.window.key("Z", ctrl=True)

    def save(self) -> None:
        """A copy of the file."""
        with self.window.override(), tempfile.TemporaryDirectory() as folder:
            bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder) / "copy.blend"), copy=True)

    def delete_wall(self) -> None:
        """Delete the obstacle."""
        self.disturbed = True
        self.remove("Wall")

    def delete_dragged(self) -> None:
        """Delete the dragged object."""
        self.disturbed = True
        if bpy.context.mode == "OBJECT":
            self.remove(self.scene[1])

    def remove(self, name: str) -> None:
        """Delete an object, if it is still there."""
        if name in bpy.data.objects:
            bpy.data.objects.remove(bpy.data.objects[name])

    def leave_mode(self) -> None:
        """Toggle Edit Mode by a script, since the drag would use the key Tab."""
        self.disturbed = True
        with self.window.override():
            if bpy.context.mode != "OBJECT":
                bpy.ops.object.mode_set(mode="OBJECT")

    def end(self) -> Steps:
        """End the drag if it still runs. After a confirmation, Esc stops its solve and keeps the state."""
        last = ""
        for key in (self.random.choice(ENDS), "ESC", "ESC"):
            if not self.window.dragging():
                return last
            last = last if last in CONFIRMING else key
            self.log.append(key)
            self.window.key(key)
            yield from self.window.settle(2)
        # Esc ends a solve at once, but its state is still written and tested, in steps.
        ended = self.described("the end of the drag")
        yield from self.window.until(lambda: not self.window.dragging(), ended, MOST_SECONDS)
        return last

    def expect_free(self, when: str) -> None:
        """The exact test of Blender's current evaluation."""
        from stiv.blender import check_scene

        found = check_scene(bpy.context)
        assert not found.pairs, self.described(f"{len(found.pairs)} intersections {when}")

    def state(self) -> list[object]:
        """Placements, and the shapes of deformed objects."""
        graph = bpy.context.evaluated_depsgraph_get()
        found: list[object] = []
        for obj in sorted(bpy.data.objects, key=lambda each: each.name):
            found.append((obj.name, [tuple(row) for row in obj.matrix_world]))
            if obj.type == "MESH":
                evaluated = obj.evaluated_get(graph)
                mesh = evaluated.to_mesh()
                found.append([tuple(vertex.co) for vertex in mesh.vertices])
                evaluated.to_mesh_clear()
        return found

    def described(self, what: str) -> str:
        """A failure with the events before it."""
        return f"{what}, in {self.scene[1]} after: {', '.join(self.log)}"


def prepared_quickly(window: Window, build: Callable[[], object], active: str, mode: str) -> Steps:
    """As `prepared`, with shorter pauses."""
    for pause in prepared(window, build, active, mode):
        yield PAUSE if pause is None else pause
    yield from window.next_draw()  # events before it may be lost


def random_sequences(window: Window) -> Steps:
    """COUNT sequences, each by its number, printed before it begins, since it may crash Blender."""
    failures = []
    for number in range(FIRST, FIRST + COUNT):
        print(f"sequence {number}", end=" ", flush=True)
        begun = time.monotonic()
        try:
            yield from Sequence(window, number).play()
        except AssertionError as failure:
            failures.append(f"sequence {number}: {failure}")
            window.picture(f"failed_sequence_{number}")
            yield from ended_by_force(window)
        outcome = failures[-1] if failures and failures[-1].startswith(f"sequence {number}:") else "passed"
        print(f"{outcome}, {time.monotonic() - begun:.1f} s", flush=True)
    assert not failures, "\n".join(failures)


def ended_by_force(window: Window) -> Steps:
    """After a failure: no drag continues into the next sequence."""
    for _ in range(3):
        window.key("ESC")
        yield from window.settle()


SEQUENCES = {"random_sequences": random_sequences}
