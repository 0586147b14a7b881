# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements of `stiv bench profile --in-blender`: frames of a script, and its drags as in the add-on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

from stiv.command_line.blender_module import addon_registered, quiet_blender, require_blender
from stiv.edit_scripts import EditScript, read_edit_script
from stiv.task import Task

PIXELS = 1000.0  # of the pointer's x for one repetition of a script


def frames_in_blender(path: Path) -> Sequence[Any]:
    """The `FrameTime` of each edit of the script of a .blend, solved completely with one thread."""
    with _opened(path) as script:
        of_scene = require_blender("stiv_addon.scene.edit_settings", path).edit_settings
        times = require_blender("benchmarks.sessions.frame_times", path)
        frames: Sequence[Any] = times.frame_times(script, lambda scene: replace(of_scene(scene), threads=1))
        return frames


def drags_in_blender(path: Path, threads: int) -> Sequence[Any]:
    """The `DraggedStage` of each drag of the same script, with the add-on's time limit for each solve."""
    with _opened(path) as script:
        settings, modal = require_blender("stiv_addon.scene.edit_settings", path), _modal(path)

        def settings_of(scene: Any) -> Any:
            return replace(settings.edit_settings(scene, time_budget=settings.DRAG_BUDGET), threads=threads)

        dragged = require_blender("benchmarks.sessions.dragged_frames", path)
        stages: Sequence[Any] = dragged.dragged_stages(
            script, settings_of, lambda kind, begin, goal_of: ScriptedDrag.begun(modal, kind, begin, goal_of)
        )
        return stages


@dataclass(frozen=True)
class ScriptedDrag:
    """The add-on's drag without a window. The x of the pointer is the progress of the mouse."""

    drag: Any
    event: Any

    @classmethod
    def begun(
        cls, modal: dict[str, ModuleType], kind: str, begin: Callable[[], Any], goal_of: Callable[[float], Any]
    ) -> ScriptedDrag:
        """A drag of a kind; `modal` are the modules of the add-on by their names."""
        state = modal["state"].State(modal["pointer"].Pointer.at((0.0, 0.0)), modal["request"].Request(kind))
        calls = modal["drag_calls"].DragCalls(
            begin=lambda request: begin(),
            transform_of=lambda state: state.pointer.effective[0] / PIXELS,
            motion_of=lambda where, state: goal_of(where),
            apply=_no_typed_values,
            task=Task,
        )
        return cls(modal["drag_loop"].DragLoop(calls, state), modal["event"].Event)

    def point(self, where: float) -> None:
        """Move the mouse."""
        self.drag.handle(self.event("MOUSEMOVE", "NOTHING", (PIXELS * where, 0.0)))

    def tick(self) -> None:
        """A timer event."""
        self.drag.tick()

    def confirm(self) -> None:
        """Enter, until the drag has ended."""
        self.drag.handle(self.event("RET"))
        while not self.drag.progress.ended:
            self.drag.tick()

    @property
    def starting(self) -> bool:
        """Whether the edit has not begun yet."""
        return self.drag.edit is None and not self.drag.progress.ended

    @property
    def at_rest(self) -> bool:
        """Whether nothing is left to solve."""
        return bool(self.drag.at_rest)

    @property
    def result(self) -> Any:
        """Result of the last solve."""
        return self.drag.result

    @property
    def written(self) -> Any:
        """The result that the scene shows."""
        return self.drag.writer.written

    @property
    def written_for(self) -> float:
        """The position of the mouse for which it was solved."""
        return float(self.drag.transform)

    @property
    def report(self) -> Any:
        """Report of the last writing."""
        return self.drag.writer.report

    @property
    def error(self) -> Exception | None:
        """The error that ended the drag."""
        error: Exception | None = self.drag.error
        return error


def _no_typed_values(where: float, state: Any) -> Any:
    raise AssertionError("a scripted drag types no values")


def _modal(path: Path) -> dict[str, ModuleType]:
    return {
        name: require_blender(f"stiv_addon.modal.{name}", path)
        for name in ("drag_calls", "drag_loop", "event", "pointer", "request", "state")
    }


@contextmanager
def _opened(path: Path) -> Iterator[EditScript]:
    """Opens a .blend with the operators of the add-on; yields its script."""
    with quiet_blender(), addon_registered(path):
        require_blender("stiv.blender.scripts.blend_files", path).open_blend(path)
        yield read_edit_script(path.with_suffix(".edits.json"))
