# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv demo`: lowers a plant into a vase and scales it up, with the operators of the add-on."""

from __future__ import annotations

import argparse
import statistics
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiv import InputError
from stiv.checks.report import summary as check_summary
from stiv.command_line.blender_module import quiet_blender, require_blender
from stiv.command_line.file_checking import check_path
from stiv.command_line.options import add_blender_option
from stiv.command_line.replay import render_scene, replay_report, run_script
from stiv.edit_scripts import read_edit_script
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.output_files import require_folder, written_atomically

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

NAME = "plant_in_vase"
PACKAGE = Path(__file__).absolute().parents[1]
FOLDERS = (PACKAGE / "demo", PACKAGE.parents[1] / "blend_fixtures")  # of a wheel, of a source checkout
MEDIANS = {"milliseconds": "ms per edit", "rounds": "rounds", "events": "events", "patches": "patches"}

_DESCRIPTION = """\
Lowers a plant into a vase, which deflects it, and scales it up: about sixty edits of a lattice. Writes before.png,
after.png, after.blend and report.json, then opens after.blend and tests it exactly."""
_EXAMPLES = """\
examples:
  stiv demo
  stiv demo --output pictures --blender /usr/bin/blender

exit codes: 0 done and free of intersections, 4 not free of them, 2 no Blender or no folder to write to,
1 wrong usage, 3 internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "demo",
        help="lower a plant into a vase in Blender, and check the result",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--output", type=Path, default=Path("stiv-demo"), metavar="FOLDER", help="(stiv-demo)")
    add_blender_option(parser)
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    begin, scene, output = time.perf_counter(), _scene(), arguments.output
    require_blender("stiv.blender.scripts.blend_files", scene)
    require_folder(output)
    output.mkdir(exist_ok=True)
    edits = _edited(scene, output)
    check = check_path(output / "after.blend")
    print(check_summary(check))
    print(_summary(edits, time.perf_counter() - begin))
    print(f"written to {output}: before.png, after.png, after.blend, report.json")
    return ExitCode.DONE if check.free else ExitCode.NOT_FREE


def _scene() -> Path:
    """The .blend, next to its script. Raises InputError if it is not installed."""
    for folder in FOLDERS:
        if (folder / f"{NAME}.blend").is_file():
            return folder / f"{NAME}.blend"
    raise InputError("demo: the scene is not installed; install the wheel, or run the demo in a source checkout")


def _edited(scene: Path, output: Path) -> list[dict[str, Any]]:
    """Runs the edits and writes the files; returns a report on each edit."""
    files = require_blender("stiv.blender.scripts.blend_files", scene)
    script = read_edit_script(scene.with_suffix(".edits.json"))
    with quiet_blender():
        files.open_blend(scene)
        render_scene(output / "before.png", scene)
        edits = run_script(script, scene)
        with written_atomically(output / "after.blend") as temporary:
            files.save_blend(temporary)
        render_scene(output / "after.png", scene)
    write_json(output / "report.json", replay_report(scene, edits))
    return edits


def _summary(edits: list[dict[str, Any]], seconds: float) -> str:
    """The result as text."""
    touching = [edit for edit in edits if edit["rounds"] > 0]
    rounds = [1000 * edit["timings"]["total"] / edit["counters"]["detections"] for edit in touching]
    lines = [f"{len(edits)} edits, {len(touching)} of them deflected, {seconds:.0f} s in total"]
    if touching:
        median = {key: statistics.median(edit[key] for edit in touching) for key in MEDIANS}
        named = ", ".join(f"{median[key]:.0f} {unit}" for key, unit in MEDIANS.items())
        lines.append(f"median of those: {named}, {statistics.median(rounds):.1f} ms per round")
    return "\n".join(lines)
