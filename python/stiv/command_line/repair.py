# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv repair`: remove the intersections that a scene or a mesh has."""

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
Contracts what intersects until the exact test finds nothing, expands it back without letting anything through, and
writes the result. Only positions of vertices change, unless --weld is given. Of a .blend, meshes change by their
cages, below a Subdivision Surface modifier; scripts in it are not run. Mesh files: {", ".join(SUFFIXES)}. The output
is written only when the exact test of what was written finds nothing; otherwise what still intersects is listed."""
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
        help="remove the intersections that a scene or a mesh has",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", type=Path, metavar="SCENE.blend|MESH", help="what to repair")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help="where the result goes")
    parser.add_argument(
        "--move", action="append", default=[], metavar="OBJECT",
        help="an object that may change, to be repeated; without it all that intersect may",
    )  # fmt: skip
    parser.add_argument("--weld", action="store_true", help="make vertices one that lie in exactly the same place")
    parser.add_argument(
        "--separation", type=float, default=0.0, metavar="H", help="distance that surfaces keep; 0 chooses one"
    )
    parser.add_argument(
        "--max-deviation", type=float, default=0.05, metavar="D",
        help="refuse what ends farther off: root mean square in diagonals of what may move (default 0.05)",
    )  # fmt: skip
    parser.add_argument(
        "--time-limit", type=float, default=0.0, metavar="S",
        help="seconds after which the best repair so far is taken, if there is one (default: no limit)",
    )  # fmt: skip
    add_guard_option(parser)
    parser.add_argument("--json", "--report", type=Path, metavar="F", help="write what was done to F, as JSON")
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
    """Repairs a .blend or a mesh file, and writes the output if that is free; a report, ready for JSON.

    Raises InputError.
    """
    chosen = choices or RepairChoices()
    if not source.is_file():
        raise InputError(f"{source}: there is no such file")
    begin = time.perf_counter()
    if source.suffix.lower() == ".blend":
        if output.suffix.lower() != ".blend":
            raise InputError(f"{output}: what comes out of a .blend is a .blend")
        outcome: RepairOutcome = repair_blend(source, output, chosen)
    else:
        require_writer(output)
        outcome = repair_mesh(source, output, chosen)
    return outcome.as_json(source, output, round(time.perf_counter() - begin, 3))


def summary(report: dict[str, Any]) -> str:
    """The result for people, one line a fact."""
    name = report["file"]
    if report["status"] == "already_free":
        return f"{name}: nothing intersects; {report['output']} is the same ({report['seconds']:.2f} s)"
    if report["free"]:
        return (
            f"{name}: {report['pairs_before']:,} intersecting pairs are gone, {report['deviation']:.2%} off in the "
            f"mean; written to {report['output']} ({report['seconds']:.2f} s)"
        )
    lines = [f"{name}: not repaired, nothing is written: {report['message']}"]
    lines += [f"  {_text(pair['first'])} - {_text(pair['second'])}" for pair in report["pairs"][:SHOWN_PAIRS]]
    more = report["pairs_left"] - SHOWN_PAIRS
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []))


def _text(element: dict[str, Any]) -> str:
    return f'object "{element["object"]}", {element["kind"]} {element["number"]}'
