# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv bench`: the paper's table, profiles of its sessions, growth, and races against other methods."""

from __future__ import annotations

import argparse
import os
import platform
import shlex
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.quality.comparison import quality, quality_text
from benchmarks.quality.pictures import draw_worst
from benchmarks.sessions.blender_profile import blender_profile
from benchmarks.sessions.cloth import cloth, cloth_text
from benchmarks.sessions.dragged_profile import dragged_text
from benchmarks.sessions.in_blender import drags_in_blender, frames_in_blender
from benchmarks.sessions.large_scene import large_scene, large_scene_text
from benchmarks.sessions.models import models, models_text
from benchmarks.sessions.profile import profile, profile_text
from benchmarks.sessions.race import race, race_text
from benchmarks.sessions.running import Report
from benchmarks.sessions.scaling import scaling, scaling_text
from benchmarks.sessions.table1 import KINDS, PUBLISHED, shares_text, table1, table_text
from stiv import InputError
from stiv._native import VectorTarget, limit_vector_target, vector_target
from stiv.command_line.program import Parser
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.output_files import require_folder

SCHEMA, VERSION = "stiv-bench", 1

_DESCRIPTION = """\
Measures whole editing sessions with the sizes of the paper, mostly without Blender, and tests each accepted state
exactly. Times are processor time for one thread, and wall time for several."""
_EXAMPLES = """\
examples:
  stiv bench table1                          the paper's Table 1, with its method and ours
  stiv bench table1 --scenes knot tree --threads 1 --json table1.json
  stiv bench profile --scenes plant dressing frames per second, edit by edit
  stiv bench profile --in-blender             drags in Blender, with its evaluation: each frame solved completely, and
                                             with the add-on's time limit, as a user sees them
  stiv bench race                            against a stop at the first contact, and our loop with ipctk (needs ipctk)
  stiv bench cloth                           against Blender's cloth simulation
  stiv bench --models FOLDER                 Figures 9 and 1 with bunny, teapot and ogre from a folder
  stiv bench quality --models FOLDER         edits beside converged solutions of an interior-point method (needs ipctk)
  stiv bench scaling --largest 300000        growth with the number of triangles
  stiv bench large                           a drag over landscapes of 1 and 10 million triangles (Linux)

exit codes: 0 done, 2 bad input, 4 an accepted state intersects, 1 wrong usage, 3 internal error, 5 cancelled"""


def parser() -> Parser:
    """The parser of the arguments after `stiv bench`."""
    parser = Parser(
        prog="stiv bench",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("what", choices=tuple(_BENCHES), nargs="?", help="what to measure")
    parser.add_argument("--scenes", nargs="+", default=list(PUBLISHED), metavar="NAME", help="default: all five")
    parser.add_argument("--threads", nargs="+", type=int, default=[1, 2], metavar="N", help="default: 1 2")
    parser.add_argument(
        "--constraints", nargs="+", choices=tuple(KINDS), default=list(KINDS), help="table1: default: both"
    )
    parser.add_argument(
        "--largest",
        type=int,
        metavar="N",
        help="scaling, large: triangles of the largest size (default: all)",
    )
    parser.add_argument(
        "--models",
        type=Path,
        metavar="FOLDER",
        help="models, quality: folder with stanford-bunny.obj, teapot.obj and ogre.obj; models: each optional",
    )
    parser.add_argument("--edits", nargs="+", default=[], metavar="NAME", help="quality: default: all")
    parser.add_argument(
        "--seconds",
        type=float,
        default=60.0,
        metavar="S",
        help="quality: limit of each converged solution (default: 60)",
    )
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="quality: draw the worst three edits")
    parser.add_argument(
        "--vectors",
        choices=[each.name for each in VectorTarget],
        help="the most vector instructions that the core uses (default: those of the processor)",
    )
    parser.add_argument("--in-blender", action="store_true", help="profile: in Blender, from the .blend files")
    parser.add_argument("--json", type=Path, metavar="F", help="write the rows to F")
    return parser


def run(given: Sequence[str]) -> ExitCode:
    """Measures what the arguments ask for. Raises InputError."""
    arguments = parser().parse_args(given)
    require_folder(arguments.json)
    if arguments.vectors is not None:
        limit_vector_target(VectorTarget[arguments.vectors])
    what = arguments.what or ("models" if arguments.models else None)
    if what is None or (what in ("models", "quality")) != (arguments.models is not None):
        raise InputError(
            f"bench: choose one of {', '.join(_BENCHES)}; only models and quality have the option --models FOLDER"
        )
    unknown = [name for name in arguments.scenes if name not in PUBLISHED]
    if unknown or min(arguments.threads) < 1:
        raise InputError(
            f"bench: there is no scene {', '.join(unknown)}" if unknown else "bench: --threads must be 1 or more"
        )
    rows, text = _BENCHES[what](arguments, _say)
    print(text)
    if arguments.json is not None:
        write_json(arguments.json, result(rows))
    return ExitCode.NOT_FREE if any(row["intersections"] for row in rows) else ExitCode.DONE


def _say(note: str) -> None:
    print(f"measured {note}", file=sys.stderr, flush=True)


def result(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The rows with command and machine, as JSON data."""
    command = shlex.join(["stiv", *sys.argv[1:]])
    machine = {
        "system": platform.system(),
        "architecture": platform.machine(),
        "processors": _processors(),
        "vectors": vector_target().name,
    }
    return {"schema": SCHEMA, "version": VERSION, "command": command, "machine": machine, "rows": rows}


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


_Result = tuple[list[dict[str, Any]], str]


def _table(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = table1(arguments.scenes, arguments.threads, report, arguments.constraints)
    return rows, table_text(rows) + "\n\n" + shares_text(rows)


def _profile(arguments: argparse.Namespace, report: Report) -> _Result:
    if arguments.in_blender:
        rows = blender_profile(arguments.scenes, frames_in_blender, drags_in_blender, arguments.threads, report)
        return rows, profile_text(rows) + "\n\n" + dragged_text(rows)
    rows = profile(arguments.scenes, arguments.threads, report)
    return rows, profile_text(rows)


def _race(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = race(arguments.scenes, report)
    return rows, race_text(rows)


def _cloth(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = cloth(report)
    return rows, cloth_text(rows)


def _models(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = models(arguments.models, arguments.threads, report)
    return rows, models_text(rows)


def _quality(arguments: argparse.Namespace, report: Report) -> _Result:
    rows, surfaces = quality(arguments.models, arguments.edits, arguments.seconds, report)
    if arguments.pictures is not None:
        draw_worst(arguments.models, rows, surfaces, arguments.pictures)
    return rows, quality_text(rows)


def _scaling(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = scaling(arguments.threads, arguments.largest or sys.maxsize, report)
    return rows, scaling_text(rows)


def _large(arguments: argparse.Namespace, report: Report) -> _Result:
    rows = large_scene(arguments.threads, arguments.largest or sys.maxsize, report)
    return rows, large_scene_text(rows)


_BENCHES: dict[str, Callable[[argparse.Namespace, Report], _Result]] = {
    "table1": _table,
    "profile": _profile,
    "race": _race,
    "cloth": _cloth,
    "models": _models,
    "scaling": _scaling,
    "large": _large,
    "quality": _quality,
}
