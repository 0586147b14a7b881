# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv resolve --write rig`: corrects the keyframes of bones and objects."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.command_line.blender_module import quiet_blender, require_blender, stored_settings
from stiv.command_line.progress import progress_bar
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.output_files import written_atomically

SCHEMA, VERSION = "stiv-resolve-rig", 1
LISTED = 10  # frames or intersections that the text names


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options that only `--write rig` uses."""
    group = parser.add_argument_group("options of --write rig")
    group.add_argument(
        "--bone", action="append", type=_bone, default=[], metavar="NAME[=DEGREES]",
        help="a bone or object that may change, and how much; * matches any text; repeatable (default: all with keys)",
    )  # fmt: skip
    group.add_argument(
        "--max-turn", type=_positive, default=30.0, metavar="DEGREES", help="largest change of an angle (default: 30)"
    )
    group.add_argument(
        "--max-move", type=_positive, default=math.inf, metavar="X",
        help="largest change of a location along an axis (default: a tenth of the size of the surfaces)",
    )  # fmt: skip
    group.add_argument(
        "--acceleration", type=_positive, default=1.1, metavar="RATIO",
        help="largest acceleration, divided by that of the input (default: 1.1)",
    )  # fmt: skip
    group.add_argument(
        "--allow-shapes", action="store_true", help="correct frames that bones alone cannot by corrective shape keys"
    )
    group.add_argument(
        "--joint-region", type=_not_negative, default=None, metavar="RADII",
        help="skin around joints that may fold, in radii of the limb; 0: none (default: the setting in the file)",
    )  # fmt: skip


def run(arguments: argparse.Namespace) -> ExitCode:
    """Resolve a scene by its keyframes."""
    with quiet_blender():
        result = _resolve(arguments)
    if arguments.report is not None:
        write_json(arguments.report, result)
    print(_summary(arguments.scene, result))
    return ExitCode.DONE if result["free"] else ExitCode.NOT_FREE


def _resolve(arguments: argparse.Namespace) -> dict[str, Any]:
    """The report. Writes the file if nothing intersects."""
    scene = arguments.scene
    files, resolving, checking, guarding, evaluations = (
        require_blender(f"stiv.blender.{name}", scene)
        for name in (
            "scripts.blend_files", "animation.rig_resolving", "verify.frame_check", "animation.guard_choice",
            "scene.guarded_evaluations",
        )
    )  # fmt: skip
    context = files.open_blend(scene)
    first, last, step = (*checking.scene_frames(context), 1) if isinstance(arguments.frames, str) else arguments.frames
    frames = list(range(first, last + 1, step))
    settings = stored_settings(context, scene)
    guard = guarding.choose_animation_guard(context, arguments.guard or settings.guard)
    options = resolving.RigOptions(
        dict(arguments.bone),
        arguments.max_turn,
        arguments.max_move,
        arguments.acceleration,
        arguments.hold,
        arguments.allow_shapes,
    )
    settings = resolving.with_options(settings, arguments.separation, arguments.joint_region)
    try:
        with progress_bar("frames", len(frames)) as advance:
            clip, correction = resolving.resolve_rig(context, frames, options, settings, advance)
    except InputError as error:
        raise InputError(f"{scene}: {error}") from error
    left: list[str] = []
    try:
        if correction.failed:
            raise _NotFreeError
        with written_atomically(arguments.output) as temporary:
            files.save_blend(temporary)
            opened = files.open_blend(temporary)
            tested = evaluations.chosen_evaluations(opened, guard.choice)
            left = resolving.remaining(opened, clip, frames, options, settings, tested)
            if left:
                raise _NotFreeError
    except _NotFreeError:
        pass
    return report_of(scene, clip, correction, left, guard)


class _NotFreeError(Exception):
    """Prevents a result with intersections from being saved."""


def report_of(scene: Path, clip: Any, correction: Any, left: Sequence[str], guard: Any) -> dict[str, Any]:
    """The report (python/stiv/schemas/resolve_rig.schema.json)."""
    rows = zip(
        correction.frames, correction.needed.tolist(), correction.turns.tolist(), correction.distances.tolist(),
        strict=True,
    )  # fmt: skip
    names = [part.name for part in clip.parts]
    frames = [
        {
            "frame": frame,
            "status": _status(frame, distance, correction),
            "intersected": was_needed,
            "turns": {name: round(turn, 6) for name, turn in zip(names, turns, strict=True) if turn > 0},
            "distance": distance,
        }
        for frame, was_needed, turns, distance in rows
    ]
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "scene": scene.name,
        "guard": guard.choice,
        "free": not (left or correction.failed),
        "pairs": list(left[:100]),
        "acceleration": min(correction.acceleration, 1e9),
        "mean_turn": float(correction.turns.mean()) if correction.turns.size else 0.0,
        "notes": [note for note in (clip.note, guard.reason) if note],
        "frames": frames,
    }


def _status(frame: int, distance: float, correction: Any) -> str:
    if frame in correction.failed:
        return "failed"
    return "shaped" if frame in correction.shaped else "corrected" if distance > 0 else "unchanged"


def _summary(scene: Path, report: dict[str, Any]) -> str:
    """The result as text."""
    failed = [frame["frame"] for frame in report["frames"] if frame["status"] == "failed"]
    if failed:
        return f"{scene}: bones alone cannot correct frames {_listed(failed)}; nothing was written"
    shaped = [frame["frame"] for frame in report["frames"] if frame["status"] == "shaped"]
    notes = [f"corrective shape keys at frames {_listed(shaped)}"] if shaped else []
    if report["pairs"]:
        lines = [f"{scene}: the evaluated result intersects; nothing was written"]
        return "\n".join(lines + [f"  {pair}" for pair in report["pairs"][:LISTED]])
    corrected = sum(frame["status"] in ("corrected", "shaped") for frame in report["frames"])
    distance = max(frame["distance"] for frame in report["frames"])
    counts = f"{len(report['frames'])} frames, {sum(f['intersected'] for f in report['frames'])} intersected, "
    counts += f"{corrected} corrected; mean change of a joint {report['mean_turn']:.2f} degrees"
    figures = f"acceleration {report['acceleration']:.2f} times the input's; maximum distance {distance:.4g}"
    return "; ".join([f"{scene}: {counts}", figures, *notes, *report["notes"]])


def _listed(frames: Sequence[int]) -> str:
    shown = ", ".join(str(frame) for frame in frames[:LISTED])
    return shown if len(frames) <= LISTED else f"{shown} and {len(frames) - LISTED} more"


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def _not_negative(text: str) -> float:
    return 0.0 if float(text) == 0 else _positive(text)


def _bone(text: str) -> tuple[str, float | None]:
    name, has_turn, turn = text.rpartition("=")
    return (name, _positive(turn)) if has_turn else (text, None)
