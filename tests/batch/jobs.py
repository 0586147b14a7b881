# SPDX-License-Identifier: GPL-3.0-or-later
"""Small jobs: balls of NPZ files that are pushed into a wall, each a little differently."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from blend_fixtures.scenes.primitives import icosphere
from stiv.mesh_files import Mesh, write_mesh
from stiv.mesh_files.mesh import checked_mesh

NAME = "scene {:03} ü"


def write_job(folder: Path, count: int, repeat: int = 3, **more: Any) -> Path:
    """A job of `count` scenes, each with an edit script of 2 x `repeat` edits."""
    for name in ("in", "out"):
        (folder / name).mkdir(exist_ok=True)
    for number in range(count):
        write_mesh(folder / f"in/{number}.npz", ball_and_wall(number))
        (folder / f"in/{number}.json").write_text(json.dumps(edits(number, repeat)))
    entries = [
        {
            "name": NAME.format(number),
            "command": "replay",
            "scene": f"in/{number}.npz",
            "edits": f"in/{number}.json",
            "output": f"out/result {number}.npz",
        }
        for number in range(count)
    ]
    job = folder / "job ü.json"
    job.write_text(json.dumps({"schema": "stiv-batch", "version": 2, "entries": entries, **more}))
    return job


def ball_and_wall(number: int) -> Mesh:
    ball = icosphere(2, 1.0).moved((0, 0, 1.3 + 0.01 * (number % 7)))
    side = np.linspace(-2, 2, 12)
    x, y = np.meshgrid(side, side, indexing="ij")
    corner = (np.arange(11)[:, None] * 12 + np.arange(11)).ravel()
    wall = np.vstack([[corner, corner + 12, corner + 13], [corner, corner + 13, corner + 1]]).reshape(2, 3, -1)
    faces = np.concatenate([wall[0].T, wall[1].T])
    heights = 0.05 * np.sin(3 * x + number)
    vertices = np.vstack([np.column_stack([x.ravel(), y.ravel(), heights.ravel()]), ball.vertices])
    triangles = np.vstack([faces, ball.triangles() + 144]).astype(np.int32)
    owner = np.repeat(np.array([0, 1], np.int32), [len(faces), len(triangles) - len(faces)])
    return checked_mesh(vertices, triangles, ("Wall", "Ball ü"), owner)


def edits(number: int, repeat: int) -> dict[str, Any]:
    push = {"operator": "move", "mode": "EDIT", "objects": ["Ball ü"], "repeat": repeat}
    slide = {"operator": "move", "objects": ["Ball ü"], "repeat": repeat}
    return {
        "schema": "stiv-edits",
        "version": 1,
        "steps": [
            push | {"values": {"value": [0.01 * number, 0, -0.2]}},
            slide | {"values": {"value": [0.05, 0.02, -0.1]}},
        ],
    }


def results(folder: Path) -> dict[str, bytes]:
    """The bytes of all outputs."""
    return {path.name: path.read_bytes() for path in sorted((folder / "out").iterdir())}


def record(folder: Path, number: int) -> dict[str, Any]:
    """The record of a scene."""
    (path,) = [each for each in (folder / "job ü.state").glob("*.json") if f"{number:03}" in each.name]
    return json.loads(path.read_text())
