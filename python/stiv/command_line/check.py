# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check`: is a scene or a mesh free of intersections? Exact."""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import stiv
from stiv import InputError
from stiv.command_line.blender_module import require_blender
from stiv.command_line.exit_codes import ExitCode
from stiv.command_line.output_files import require_folder, write_json
from stiv.command_line.quiet import quiet_blender
from stiv.mesh_files import SUFFIXES, read_mesh

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

SCHEMA, VERSION = "stiv-check", 1
LISTED_PAIRS = 100  # in the report
SHOWN_PAIRS = 10  # on the terminal

_Element = tuple[str, str, int]

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


@dataclass(frozen=True)
class _Finding:
    """What was tested, and the pairs that meet: each end as object, kind of element and number within the object."""

    objects: tuple[str, ...]
    vertices: int
    triangles: int
    pairs: list[tuple[_Element, _Element]]


def check_file(path: Path) -> dict[str, Any]:
    """The result of the exact test of a .blend or a mesh file, ready for JSON. Raises InputError."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    begin = time.perf_counter()
    found = _check_blend(path) if path.suffix.lower() == ".blend" else _check_mesh(path)
    listed = [{"first": _named(first), "second": _named(second)} for first, second in found.pairs[:LISTED_PAIRS]]
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "file": path.name,
        "objects": list(found.objects),
        "vertices": found.vertices,
        "triangles": found.triangles,
        "free": not found.pairs,
        "intersections": len(found.pairs),
        "pairs": listed,
        "seconds": round(time.perf_counter() - begin, 3),
    }


def summary(report: dict[str, Any]) -> str:
    """The result for people, one line a fact."""
    size = f"{report['vertices']:,} vertices, {report['triangles']:,} triangles, {len(report['objects'])} objects"
    if report["free"]:
        return f"{report['file']}: free of intersections ({size}, {report['seconds']:.2f} s)"
    lines = [f"{report['file']}: {report['intersections']:,} intersecting pairs ({size})"]
    lines += [f"  {_text(pair['first'])} - {_text(pair['second'])}" for pair in report["pairs"][:SHOWN_PAIRS]]
    more = report["intersections"] - SHOWN_PAIRS
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []))


def _named(element: _Element) -> dict[str, Any]:
    name, kind, number = element
    return {"object": name, "kind": kind, "number": number}


def _text(element: dict[str, Any]) -> str:
    return f'object "{element["object"]}", {element["kind"]} {element["number"]}'


def _check_mesh(path: Path) -> _Finding:
    mesh = read_mesh(path)
    owner = mesh.triangle_object
    first_of_object = np.searchsorted(np.sort(owner), np.arange(len(mesh.object_names)))
    within = np.empty(len(owner), np.int64)
    within[np.argsort(owner, kind="stable")] = np.arange(len(owner))

    def element(triangle: int) -> _Element:
        of = int(owner[triangle])
        return mesh.object_names[of], "triangle", int(within[triangle] - first_of_object[of])

    pairs = stiv.find_intersections(mesh.vertices, mesh.triangles)
    named = [(element(a), element(b)) for a, b in pairs.tolist()]
    return _Finding(mesh.object_names, len(mesh.vertices), len(mesh.triangles), named)


def _check_blend(path: Path) -> _Finding:
    """Of every visible mesh as Blender evaluates it; loose edges and vertices are tested too."""
    files = require_blender("stiv.blender.blend_files", path)
    with quiet_blender():
        context = files.open_blend(path)
    checking = require_blender("stiv.blender.checking", path)
    assembly = checking.read_surface(context)
    pairs = [(_plain(pair.first), _plain(pair.second)) for pair in checking.find_pairs(assembly)]
    objects = tuple(dict.fromkeys(mesh.owner.name for mesh in assembly.meshes))
    return _Finding(objects, len(assembly.positions), len(assembly.surface.triangles), pairs)


def _plain(element: Any) -> _Element:
    return element.object, element.kind, element.number
