# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv resolve`: corrects an animation so that nothing intersects."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import stiv
from stiv import InputError
from stiv.checks.findings import Finding
from stiv.command_line import resolve_rig
from stiv.command_line.blender_module import quiet_blender, require_blender, stored_settings
from stiv.command_line.options import add_blender_option, add_guard_option, frame_range
from stiv.command_line.progress import progress_bar
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.output_files import require_folder, written_atomically

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

SCHEMA, VERSION = "stiv-resolve", 2

_DESCRIPTION = """\
Corrects an animation so that nothing intersects. The pose of each frame is a goal, and its edit starts from the
accepted state of the previous frame. The new file contains transforms as keyframes and shapes as shape keys.
`--write rig` instead corrects the keyframes of the bones and objects that have some, smoothly over time: no mesh is
baked, and constraints stay. The frames, and the motion between them, are tested before the file is saved. Scripts in
the file do not run. docs/animation.md has the details."""
_EXAMPLES = """\
examples:
  stiv resolve walk.blend --frames 1:120 -o resolved.blend
  stiv resolve walk.blend --frames scene -o resolved.blend --hold Hand --report frames.json
  stiv resolve walk.blend --frames scene -o clean.blend --write rig --bone 'Arm.*' --bone 'Hand.*=10'

exit codes: 0 done, 4 the first frame, or the evaluated result, has intersections (nothing is written), 2 bad input,
1 wrong usage, 3 internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "resolve",
        help="correct an animation so that nothing intersects",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("scene", type=Path, metavar="SCENE.blend", help="the scene with the animation")
    parser.add_argument("--frames", type=frame_range, required=True, metavar="A:B[:STEP]", help="frames, or `scene`")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT.blend", help="the output file")
    parser.add_argument(
        "--hold",
        action="append",
        default=[],
        metavar="NAME",
        help="an object that follows its animation exactly, repeatable",
    )
    parser.add_argument(
        "--separation", type=float, default=0.0, metavar="X", help="minimum distance, world units (default: automatic)"
    )
    parser.add_argument(
        "--write",
        choices=("shapes", "rig"),
        default="shapes",
        help="shapes: placements, and a shape key for each frame; rig: keyframes of the animated bones and objects",
    )
    resolve_rig.add_options(parser)
    add_guard_option(parser)
    parser.add_argument("--report", type=Path, metavar="F", help="write a report on each frame to F, as JSON")
    add_blender_option(parser)
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    for path in (arguments.output, arguments.report):
        require_folder(path)
    if not arguments.scene.is_file():
        raise InputError(f"{arguments.scene}: there is no such file")
    if arguments.write == "rig":
        return resolve_rig.run(arguments)
    try:
        with quiet_blender():
            left, frames, guard = _resolve(arguments)
    except stiv.StartIntersectsError as error:
        print("; ".join([f"{arguments.scene}: the first frame: {error}", *getattr(error, "__notes__", ())]))
        return ExitCode.NOT_FREE
    if arguments.report is not None:
        write_json(arguments.report, report_of(arguments.scene, left, frames, guard.choice))
    print("; ".join(filter(None, [summary(arguments.scene, left, frames), guard.reason])))
    return ExitCode.NOT_FREE if left else ExitCode.DONE


def _resolve(arguments: argparse.Namespace) -> tuple[list[Finding], Sequence[dict[str, Any]], Any]:
    """Intersections in the result, a report on each frame, and the guard. Writes the file if nothing intersects."""
    scene = arguments.scene
    files, poses, resolving, writing, checking, keyed, guarding, evaluations = (
        require_blender(f"stiv.blender.{name}", scene)
        for name in (
            "scripts.blend_files", "animation.tracks", "animation.resolving", "animation.writing",
            "verify.frame_check", "verify.keyed_frames", "animation.guard_choice", "scene.guarded_evaluations",
        )
    )  # fmt: skip
    context = files.open_blend(scene)
    chosen = arguments.frames
    first, last, step = (*checking.scene_frames(context), 1) if isinstance(chosen, str) else chosen
    frames = list(range(first, last + 1, step))
    checking.set_frame(context.scene, first)
    guard = guarding.choose_animation_guard(context, arguments.guard or stored_settings(context, scene).guard)
    try:
        tracks = guarding.written_tracks(poses.read_tracks(context, frames, guard.evaluations))
        with progress_bar("frames", len(frames)) as advance:
            resolved = resolving.resolve(tracks, frames, arguments.hold, arguments.separation, 0, advance)
    except stiv.StartIntersectsError:
        raise
    except InputError as error:
        raise InputError(f"{scene}: {error}") from error
    writing.write_animation(context, tracks, resolved)
    alike = _alike(tracks, resolved.moving_sets)
    try:
        with written_atomically(arguments.output) as temporary:
            files.save_blend(temporary)
            opened = files.open_blend(temporary)
            tested = evaluations.chosen_evaluations(opened, guard.choice)
            looks = checking.check_frames(opened, _tested(frames, keyed), evaluations=tested)
            left = [found for look in looks for found in look.findings if not _keeps(found, alike)]
            if left:
                raise _NotFreeError
    except _NotFreeError:
        pass
    return left, resolved.frames, guard


def _tested(frames: Sequence[int], keyed: Any) -> list[float]:
    """The frames that `stiv check` tests by default: all frames of the range, and keys between them."""
    found: list[float] = keyed.add_subframe_keys(range(frames[0], frames[-1] + 1))
    return found


class _NotFreeError(Exception):
    """Prevents a result with intersections from being saved."""


def report_of(scene: Path, left: Sequence[Finding], frames: Sequence[dict[str, Any]], guard: str) -> dict[str, Any]:
    """The report (python/stiv/schemas/resolve.schema.json)."""
    pairs = [str(finding) for finding in left[:100]]
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "scene": scene.name,
        "guard": guard,
        "free": not left,
        "pairs": pairs,
        "frames": list(frames),
    }


def summary(scene: Path, left: Sequence[Finding], frames: Sequence[dict[str, Any]]) -> str:
    """The result as text."""
    if left:
        lines = [f"{scene}: {len(left)} intersecting pairs in the evaluated result; nothing was written"]
        return "\n".join(lines + [f"  {finding}" for finding in left[:10]])
    corrected = [frame for frame in frames if frame["rounds"] > 0]
    blocked = sum(frame["status"] == "blocked" for frame in frames)
    away = max((frame["distance"] for frame in frames), default=0.0)
    counts = f"{len(frames)} frames, {len(corrected)} corrected, {blocked} blocked"
    return f"{scene}: {counts}; maximum distance from the animation {away:.4g}"


def _alike(tracks: Sequence[Any], parts: Sequence[Any]) -> dict[str, int]:
    """Numbers of objects. Objects that do not move relative to each other have the same: static ones, each group."""
    numbers = {track.mesh.owner.name: -1 for track in tracks}
    for number, part in enumerate(parts):
        numbers.update({tracks[index].mesh.owner.name: number for index in part.tracks if part.frame is None})
        numbers.update({tracks[index].mesh.owner.name: -2 - index for index in part.tracks if part.frame is not None})
    return numbers


def _keeps(finding: Finding, alike: dict[str, int]) -> bool:
    """Whether a finding is between objects that never move relative to each other, so that it existed before."""
    one, other = (alike.get(name, -1) for name in finding.objects)  # what is only rendered has no track
    return one == other and one >= -1
