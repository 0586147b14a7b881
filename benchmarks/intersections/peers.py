# SPDX-License-Identifier: GPL-3.0-or-later
"""The peers of the static test: ipctk and libigl from PyPI, CGAL as a program of this folder."""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
CGAL = Path("build/bench/benchmarks/intersections/cgal_self_intersections")


@cache
def missing(name: str, way: str) -> None:
    """Print once how to install a missing peer."""
    print(f"{name} is not there, its column stays empty: {way}")


def ipc_toolkit(vertices: Array, faces: Faces) -> Callable[[], object] | None:
    """`has_intersections`: whether any edge intersects a face, in floating point; stops at the first."""
    try:
        import ipctk
    except ImportError:
        missing("ipctk", "pip install -r tools/requirements/bench.txt")
        return None
    ipctk.set_num_threads(1)
    ipctk.set_logger_level(ipctk.off)
    columns = np.asfortranarray(vertices)
    mesh = ipctk.CollisionMesh(columns, ipctk.edges(faces), faces)
    return lambda: ipctk.has_intersections(mesh, columns, ipctk.LBVH())


def libigl(vertices: Array, faces: Faces, *, first_only: bool = False) -> Callable[[], object] | None:
    """`find_self_intersections`: all pairs, or whether there is one; exact predicates."""
    try:
        import igl.predicates
    except ImportError:
        missing("libigl", "pip install -r tools/requirements/bench.txt")
        return None
    wide = faces.astype(np.int64)
    return lambda: igl.predicates.find_self_intersections(vertices, wide, first_only)


class Cgal:
    """`self_intersections`: all pairs, exact predicates; the program measures its own time."""

    def __init__(self, program: Path, vertices: Array, faces: Faces) -> None:
        self._program, self._vertices, self._faces = program, vertices, faces

    def run(self, repeats: int) -> dict[str, float] | None:
        """Milliseconds ("all", "first") and the number of pairs; None if the program is not built."""
        if not self._program.exists():
            missing("CGAL", "install Debian's libcgal-dev, then `make peers`")
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mesh.off"
            lines = ["OFF", f"{len(self._vertices)} {len(self._faces)} 0"]
            lines += [" ".join(map(repr, row)) for row in self._vertices.tolist()]
            lines += [f"3 {a} {b} {c}" for a, b, c in self._faces.tolist()]
            path.write_text("\n".join(lines) + "\n")
            text = subprocess.run([self._program, path, str(repeats)], check=True, capture_output=True, text=True)
        result: dict[str, float] = json.loads(text.stdout)
        return result
