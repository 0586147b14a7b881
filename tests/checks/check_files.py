# SPDX-License-Identifier: GPL-3.0-or-later
"""Small OBJ files with two triangles, disjoint or crossing."""

from pathlib import Path

APART = "o below\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no above\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 4 5 6\n"
CROSSING = "o flat\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no upright ü\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 2 2 0\nf 4 5 6\n"
CROSSING_TWICE = CROSSING + "v 0.1 0.2 -1\nv 0.1 0.2 1\nv 2 2.1 0\nf 7 8 9\n"


def written(path: Path, text: str) -> str:
    path.write_text(text, encoding="utf-8")
    return str(path)
