# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check`: are scenes and meshes free of intersections? Exact."""

from __future__ import annotations

import argparse
import glob
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiv import InputError
from stiv.checks.baseline import Baseline, baseline_of, read_baseline, without_accepted
from stiv.checks.findings import FileCheck
from stiv.checks.junit import junit_xml
from stiv.checks.pictures import require_matplotlib
from stiv.checks.report import file_report, report_of, summary
from stiv.choices import GUARDS
from stiv.command_line.file_checking import CheckOptions, check_path
from stiv.command_line.options import add_blender_option, frame_range
from stiv.command_line.progress import progress_bar
from stiv.command_line.separate_checks import CheckProcess
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.mesh_files import SUFFIXES
from stiv.output_files import require_folder, written_atomically

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

Check = Callable[[Path, CheckOptions, Callable[[str], None]], FileCheck]

_DESCRIPTION = f"""\
Tests exactly whether two triangles intersect apart from the vertices and edges that they share. Contact, coplanar
overlap and duplicates count as intersections. Faces of an object that only touch at coincident vertices count as
seams. In a .blend, all visible and rendered meshes of all scenes are tested as Blender evaluates them, and untested
objects are counted. Scripts in the file do not run. Mesh files: {", ".join(SUFFIXES)}. docs/checks.md has the
details."""
_EXAMPLES = """\
examples:
  stiv check plant.blend
  stiv check --json report.json "two sheets.obj"
  stiv check assets/*.blend --junit checks.xml --pictures pictures
  stiv check walk.blend --frames 1:120        every frame, and the ways between them
  stiv check film.blend --scene "Shot 10" --hidden
  stiv check assets/*.blend --baseline known.json --write-baseline
  stiv check assets/*.blend --baseline known.json
  stiv check plant.blend --blender /opt/blender/blender

exit codes: 0 free of intersections, 4 intersections found, 2 bad input, 1 wrong usage, 3 internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "check",
        help="test scenes and meshes for intersections",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("files", nargs="+", metavar="SCENE.blend|MESH", help="the files to check")
    parser.add_argument(
        "--object", action="append", default=[], metavar="NAME", help="test only this object, repeatable"
    )
    parser.add_argument("--scene", default="all", metavar="NAME|all", help="test this scene of a .blend (default: all)")
    parser.add_argument("--render", action="store_true", help="test render levels of any size")
    parser.add_argument(
        "--guard", choices=GUARDS, default="auto",
        help="test the viewport, the render or both (default: auto, both unless the render is very large)",
    )  # fmt: skip
    parser.add_argument("--hidden", action="store_true", help="also test hidden and excluded objects")
    parser.add_argument(
        "--frames",
        type=frame_range,
        metavar="A:B[:STEP]",
        help="test these frames and the motion between them; `scene` for the frame range of the scene",
    )
    parser.add_argument("--subframes", type=int, default=1, metavar="N", help="poses per frame step (default: 1)")
    parser.add_argument("--seams", action="store_true", help="list the pairs of faces that only touch along seams")
    parser.add_argument("--baseline", type=Path, metavar="F", help="accept the findings in F")
    parser.add_argument("--write-baseline", action="store_true", help="write all findings to the baseline")
    parser.add_argument("--json", type=Path, metavar="F", help="write a report to F, as JSON")
    parser.add_argument("--junit", type=Path, metavar="F", help="write a report to F, as JUnit XML")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="write pictures of findings to FOLDER")
    add_blender_option(parser)
    parser.set_defaults(run=_run)


def check_file(path: Path) -> dict[str, Any]:
    """The report on a .blend or a mesh file, as JSON data. Raises InputError."""
    return file_report(check_path(path))


def _run(arguments: argparse.Namespace) -> ExitCode:
    _check_arguments(arguments)
    baseline = {} if arguments.baseline is None or arguments.write_baseline else read_baseline(arguments.baseline)
    paths = list(_expanded(arguments.files))
    checks = []
    with progress_bar("check", len(paths)) as advance, _checking(paths) as check_one:
        for path in paths:
            checks.append(_checked(check_one, path, arguments, baseline, lambda note: advance(note, 0)))
            advance(path.name)
    for check in checks:
        print(summary(check, arguments.seams), file=sys.stderr if check.error else sys.stdout)
    if all(check.error for check in checks):
        return ExitCode.BAD_INPUT  # nothing is written
    _write(arguments, checks)
    if any(check.error for check in checks):
        return ExitCode.BAD_INPUT
    free = arguments.write_baseline or all(check.free for check in checks)
    return ExitCode.DONE if free else ExitCode.NOT_FREE


def _check_arguments(arguments: argparse.Namespace) -> None:
    for path in (arguments.json, arguments.junit, arguments.baseline):
        require_folder(path)
    if arguments.write_baseline and arguments.baseline is None:
        raise InputError("--write-baseline requires --baseline F, the file to write")
    if arguments.render and arguments.guard == "viewport":
        raise InputError("--render tests the render, and --guard viewport does not; use one of them")
    if not 1 <= arguments.subframes <= 1000:
        raise InputError(f"--subframes: {arguments.subframes} is not between 1 and 1000")
    if arguments.pictures is not None:
        require_matplotlib()
        require_folder(arguments.pictures)
        arguments.pictures.mkdir(exist_ok=True)


def _expanded(names: Iterable[str]) -> Iterator[Path]:
    """The files of the arguments. Expands patterns that the shell has not expanded."""
    for name in names:
        matches = [] if Path(name).exists() else sorted(glob.glob(name))
        yield from map(Path, matches or [name])


@contextmanager
def _checking(paths: Sequence[Path]) -> Iterator[Check]:
    """How files are checked: several .blend files in a process of its own, unless this is an installed Blender."""
    if "bpy" in sys.modules or sum(path.suffix.lower() == ".blend" for path in paths) < 2:
        yield check_path
        return
    process = CheckProcess()
    try:
        yield process.check
    finally:
        process.close()


def _checked(
    check_one: Check, path: Path, arguments: argparse.Namespace, baseline: Baseline, on_look: Callable[[str], None]
) -> FileCheck:
    choices = CheckOptions(
        tuple(arguments.object), arguments.frames, arguments.subframes, arguments.pictures, arguments.scene,
        arguments.render, arguments.hidden, arguments.guard,
    )  # fmt: skip
    try:
        check = check_one(path, choices, on_look)
    except InputError as error:
        return FileCheck(path.as_posix(), error=str(error).removeprefix(f"{path}: "))
    return without_accepted(check, baseline, arguments.baseline.parent) if baseline else check


def _write(arguments: argparse.Namespace, checks: list[FileCheck]) -> None:
    if arguments.write_baseline:
        write_json(arguments.baseline, baseline_of(checks, arguments.baseline.parent))
    if arguments.json is not None:
        write_json(arguments.json, report_of(checks, arguments.seams))
    if arguments.junit is not None:
        with written_atomically(arguments.junit) as temporary:
            temporary.write_bytes(junit_xml(checks))
