# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv replay`: runs an edit script on a .blend with the operators of the add-on, or on a mesh file."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiv import InputError
from stiv.command_line.blender_module import addon_registered, quiet_blender, require_blender
from stiv.command_line.options import add_blender_option, add_guard_option
from stiv.command_line.progress import progress_bar
from stiv.edit_scripts import EditScript, read_edit_script
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.mesh_files import read_mesh, require_writer, write_mesh
from stiv.mesh_replay import replay_on_mesh
from stiv.output_files import require_folder, written_atomically

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

SCHEMA, VERSION = "stiv-replay", 1

_DESCRIPTION = """\
Opens a .blend (scripts in it do not run), runs the edits of an edit script with the operators of the add-on, and saves
the result. Mesh files need no Blender. docs/edit_scripts.md describes the format of edit scripts."""
_EXAMPLES = """\
examples:
  stiv replay scene.blend edits.json -o edited.blend
  stiv replay scene.blend edits.json -o edited.blend --report report.json --render picture.png
  stiv replay two_sheets.obj edits.json -o edited.obj

exit codes: 0 done, 2 bad input (nothing is written), 4 with --check: something intersects after an edit,
1 wrong usage, 3 internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "replay",
        help="run an edit script on a scene or a mesh",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("scene", type=Path, metavar="SCENE.blend|MESH", help="the file to edit")
    parser.add_argument("edits", type=Path, metavar="EDITS.json", help="the edit script")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="OUT",
        help="the output file: a .blend or a mesh file",
    )
    parser.add_argument("--report", type=Path, metavar="F", help="write a report on each edit to F, as JSON")
    parser.add_argument("--check", action="store_true", help="run the exact test after each edit of a .blend")
    parser.add_argument("--render", type=Path, metavar="F.png", help="render the result to F.png")
    add_guard_option(parser)
    add_blender_option(parser)
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    for path in (arguments.output, arguments.report, arguments.render):
        require_folder(path)
    if not arguments.scene.is_file():
        raise InputError(f"{arguments.scene}: there is no such file")
    script = read_edit_script(arguments.edits)
    if arguments.guard and arguments.scene.suffix.lower() == ".blend":
        script = replace(script, settings={**script.settings, "guard": arguments.guard})
    is_blend = arguments.scene.suffix.lower() == ".blend"
    edits = _replay_scene(arguments, script) if is_blend else _replay_mesh(arguments, script)
    if arguments.report is not None:
        write_json(arguments.report, replay_report(arguments.scene, edits))
    print(summary(edits))
    return ExitCode.NOT_FREE if any(edit.get("intersections") for edit in edits) else ExitCode.DONE


def _replay_scene(arguments: argparse.Namespace, script: EditScript) -> list[dict[str, Any]]:
    files = require_blender("stiv.blender.scripts.blend_files", arguments.scene)
    with quiet_blender():
        files.open_blend(arguments.scene)
        edits = run_script(script, arguments.scene, arguments.check)
        with written_atomically(arguments.output) as temporary:
            files.save_blend(temporary)
        if arguments.render is not None:
            render_scene(arguments.render, arguments.scene)
    return edits


def _replay_mesh(arguments: argparse.Namespace, script: EditScript) -> list[dict[str, Any]]:
    if arguments.render is not None:
        raise InputError("--render: a mesh file has no camera")
    if arguments.check:
        raise InputError("--check only supports .blend files; run `stiv check` on mesh files")
    require_writer(arguments.output)
    mesh = read_mesh(arguments.scene)
    with progress_bar("edits", len(script)) as advance:
        try:
            edited, edits = replay_on_mesh(script, mesh, lambda edit: advance(edit["status"]))
        except InputError as error:
            raise InputError(f"{arguments.scene}: {error}") from error
    with written_atomically(arguments.output) as temporary:
        write_mesh(temporary, edited)
    return edits


def run_script(script: EditScript, scene: Path, check: bool = False) -> list[dict[str, Any]]:
    """Runs a script on the open scene, with a progress bar; returns a report on each edit, as JSON data.

    check: whether to run the exact test after each edit.
    """
    replaying = require_blender("stiv.blender.scripts.replaying", scene)
    with addon_registered(scene), progress_bar("edits", len(script)) as advance:
        edits: list[dict[str, Any]] = replaying.replay(script, lambda edit: advance(edit["status"]), check)
    return edits


def render_scene(picture: Path, scene: Path) -> None:
    """Renders the open scene, from the file `scene`, to a PNG file."""
    files = require_blender("stiv.blender.scripts.blend_files", scene)
    with written_atomically(picture) as temporary, quiet_blender(errors=True):
        files.render_picture(temporary)


def replay_report(scene: Path, edits: list[dict[str, Any]]) -> dict[str, Any]:
    """The report of a replay, as JSON data."""
    return {"schema": SCHEMA, "version": VERSION, "scene": scene.name, "edits": edits}


def summary(edits: list[dict[str, Any]]) -> str:
    """The result as a line of text."""
    milliseconds = sum(edit["milliseconds"] for edit in edits)
    rounds = sum(edit["rounds"] for edit in edits)
    stopped = sum(edit["status"] == "blocked" for edit in edits)
    text = f"{len(edits)} edits, {rounds} rounds, {milliseconds / 1000:.1f} s; {stopped} edits blocked"
    tested = [edit["intersections"] for edit in edits if "intersections" in edit]
    return f"{text}; {sum(tested)} intersections in {len(tested)} states" if tested else text
