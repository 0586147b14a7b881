# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv repair`: removes the intersections of a scene or a mesh."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiv import InputError
from stiv.command_line.options import add_blender_option, add_guard_option
from stiv.command_line.repair_blend import repair_blend
from stiv.command_line.repair_mesh import repair_mesh
from stiv.command_line.repair_report import SHOWN_PAIRS, RepairChoices, RepairOutcome
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.mesh_files import SUFFIXES, require_writer
from stiv.output_files import require_folder

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

_DESCRIPTION = f"""\
Contracts intersecting meshes until the exact test finds nothing, and expands them with collisions. Only positions of
vertices change, unless --weld is given. In a .blend, cages below a Subdivision Surface modifier change; scripts in the
file do not run. Mesh files: {", ".join(SUFFIXES)}. The output is only written if the exact test finds nothing in it.
Otherwise the command lists the remaining intersections."""
_EXAMPLES = """\
examples:
  stiv repair figure.blend -o repaired.blend
  stiv repair dressed.blend -o repaired.blend --move Body
  stiv repair --weld --json report.json scan.obj -o repaired.obj

exit codes: 0 free of intersections and written, 4 not repaired (nothing is written), 2 bad input, 1 wrong usage,
3 internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "repair",
        help="remove the intersections of a scene or a mesh",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", type=Path, metavar="SCENE.blend|MESH", help="the file to repair")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help="the output file")
    parser.add_argument(
        "--move", action="append", default=[], metavar="OBJECT",
        help="an object that may change, repeatable (default: all that intersect)",
    )  # fmt: skip
    parser.add_argument("--weld", action="store_true", help="merge coincident vertices first")
    parser.add_argument(
        "--separation",
        type=float,
        default=0.0,
        metavar="H",
        help="minimum distance between surfaces (default: automatic)",
    )
    parser.add_argument(
        "--max-deviation", type=float, default=0.05, metavar="D",
        help="maximum root mean square deviation, in diagonals of the movable surface (default: 0.05)",
    )  # fmt: skip
    parser.add_argument(
        "--time-limit", type=float, default=0.0, metavar="S",
        help="accept the best repair found within S seconds, if any (default: no limit)",
    )  # fmt: skip
    add_guard_option(parser)
    parser.add_argument("--json", "--report", type=Path, metavar="F", help="write a report to F, as JSON")
    add_blender_option(parser)
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    choices = RepairChoices(
        tuple(arguments.move), arguments.weld, arguments.separation, arguments.max_deviation, arguments.time_limit,
        arguments.guard,
    )  # fmt: skip
    for path in (arguments.output, arguments.json):
        require_folder(path)
    report = repair_file(arguments.file, arguments.output, choices)
    if arguments.json is not None:
        write_json(arguments.json, report)
    print(summary(report))
    return ExitCode.DONE if report["free"] else ExitCode.NOT_FREE


def repair_file(source: Path, output: Path, choices: RepairChoices | None = None) -> dict[str, Any]:
    """Repairs a .blend or a mesh file, writes the output if it is free, and returns a report, as JSON data.

    Raises InputError.
    """
    chosen = choices or RepairChoices()
    if not source.is_file():
        raise InputError(f"{source}: there is no such file")
    begin = time.perf_counter()
    if source.suffix.lower() == ".blend":
        if output.suffix.lower() != ".blend":
            raise InputError(f"{output}: the output of a .blend must be a .blend")
        outcome: RepairOutcome = repair_blend(source, output, chosen)
    else:
        require_writer(output)
        outcome = repair_mesh(source, output, chosen)
    return outcome.as_json(source, output, round(time.perf_counter() - begin, 3))


def summary(report: dict[str, Any]) -> str:
    """The result as text."""
    name = report["file"]
    if report["status"] == "already_free":
        return f"{name}: no intersections; {report['output']} is a copy ({report['seconds']:.2f} s)"
    if report["free"]:
        text = (
            f"{name}: resolved {report['pairs_before']:,} intersections, mean deviation {report['deviation']:.2%}; "
            f"written to {report['output']} ({report['seconds']:.2f} s)"
        )
        return f"{text}; {report['message']}" if report["message"] else text
    lines = [f"{name}: not repaired, nothing was written: {report['message']}"]
    lines += [f"  {_text(pair['first'])} - {_text(pair['second'])}" for pair in report["pairs"][:SHOWN_PAIRS]]
    more = report["pairs_left"] - SHOWN_PAIRS
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []))


def _text(element: dict[str, Any]) -> str:
    return f'object "{element["object"]}", {element["kind"]} {element["number"]}'
