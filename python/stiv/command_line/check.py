# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check`: is a scene or a mesh free of intersections? Exact."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.command_line.blender_module import require_blender
from stiv.command_line.exit_codes import ExitCode
from stiv.command_line.output_files import require_folder, write_json
from stiv.mesh_files import SUFFIXES, Mesh, read_mesh

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

SCHEMA, VERSION = "stiv-check", 1
LISTED_PAIRS = 100

_DESCRIPTION = f"""\
Tests exactly whether any two triangles meet other than in the vertices and edges they share. Touching, coplanar
overlap and duplicates count. Of a .blend, every visible mesh is taken as Blender evaluates it; scripts in it are not
run. Mesh files: {", ".join(SUFFIXES)}."""
_EXAMPLES = """\
examples:
  stiv check plant.blend
  stiv check --json report.json "two sheets.obj"

exit codes: 0 free of intersections, 4 intersections found, 2 bad input, 1 wrong usage, 3 internal error"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "check",
        help="is a scene or a mesh free of intersections?",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", type=Path, metavar="SCENE.blend|MESH", help="what to check")
    parser.add_argument("--json", type=Path, metavar="F", help="write the result, with the pairs, to F")
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    require_folder(arguments.json)
    report = check_file(arguments.file)
    if arguments.json is not None:
        write_json(arguments.json, report)
    print(summary(report))
    return ExitCode.DONE if report["free"] else ExitCode.NOT_FREE


def check_file(path: Path) -> dict[str, Any]:
    """The result of the exact test of a .blend or a mesh file, ready for JSON. Raises InputError."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    begin = time.perf_counter()
    mesh = _evaluated(path) if path.suffix.lower() == ".blend" else read_mesh(path)
    pairs = stiv.find_intersections(mesh.vertices, mesh.triangles)
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "file": path.name,
        "objects": list(mesh.object_names),
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.triangles),
        "free": len(pairs) == 0,
        "intersections": len(pairs),
        "pairs": _named_pairs(pairs[:LISTED_PAIRS], mesh),
        "seconds": round(time.perf_counter() - begin, 3),
    }


def summary(report: dict[str, Any]) -> str:
    """The result for people, one line a fact."""
    size = f"{report['vertices']:,} vertices, {report['triangles']:,} triangles, {len(report['objects'])} objects"
    if report["free"]:
        return f"{report['file']}: free of intersections ({size}, {report['seconds']:.2f} s)"
    lines = [f"{report['file']}: {report['intersections']:,} intersecting pairs of triangles ({size})"]
    lines += [_pair_text(pair) for pair in report["pairs"][:10]]
    more = report["intersections"] - 10
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []))


def _pair_text(pair: dict[str, Any]) -> str:
    first, second = pair["first"], pair["second"]
    return (
        f'  object "{first["object"]}", triangle {first["triangle"]} - '
        f'object "{second["object"]}", triangle {second["triangle"]}'
    )


def _named_pairs(pairs: NDArray[np.int32], mesh: Mesh) -> list[dict[str, Any]]:
    """Pairs by object and by the triangle's number within its object."""
    owner = mesh.triangle_object
    within = np.zeros(len(owner), np.int64)
    for number in range(len(mesh.object_names)):
        mine = np.flatnonzero(owner == number)
        within[mine] = np.arange(len(mine))

    def named(triangle: int) -> dict[str, Any]:
        return {"object": mesh.object_names[owner[triangle]], "triangle": int(within[triangle])}

    return [{"first": named(a), "second": named(b)} for a, b in pairs]


def _evaluated(path: Path) -> Mesh:
    files = require_blender("stiv.blender.blend_files", path)
    mesh: Mesh = files.evaluated_mesh(path)
    return mesh
