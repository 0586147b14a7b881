# SPDX-License-Identifier: GPL-3.0-or-later
"""Duration of a round of the plant edit, split by step, with machine-independent counters.

A round is one pass of the loop: a detection and, if it finds events, the response. The time of an edit,
including acceptance, is divided evenly among its rounds. On a busy machine, processor time is more meaningful
than wall time.

    python benchmarks/plant_rounds.py [--threads 1] [--edits N] [--json FILE]

The scene and its edits are those of the fixture plant_in_vase (13,759 vertices, 26,782 triangles: the size of
the example of Figure 8 in the paper, which reports 40.6 to 48.6 ms a round), solved by the core without
Blender.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import stiv
from blend_fixtures.scenes.motion import Step
from blend_fixtures.scenes.plant_in_vase import plant_in_vase
from blend_fixtures.scenes.shape import joined

PARTS = ("deformation", "detection", "volumes", "response", "acceptance")
COUNTERS = ("rounds", "detections", "candidate_pairs", "pairs_tested", "events", "acceptance_tries")


def plant_session(threads: int) -> stiv.EditSession:
    """Shoots in a lattice, whose points are the controls, above the vase, an obstacle."""
    fixture = plant_in_vase()
    grid = fixture.lattices[0]
    shoots, vase = (mesh.shape for mesh in fixture.meshes)
    surface = joined([shoots, vase])
    moved = np.arange(len(shoots.vertices))
    bodies = [stiv.Body("Shoots"), stiv.Body("Vase", "fixed")]
    topology = stiv.Surface(
        surface.triangles(), vertex_body=np.repeat([0, 1], [len(moved), len(vase.vertices)]), bodies=bodies
    )
    frame = grid.placement.matrix()
    deformation = stiv.concatenate(
        [(stiv.lattice(shoots.vertices, grid.resolution, frame=frame), moved)], surface.vertices
    )
    points = stiv.lattice_rest_points(grid.resolution) @ frame[:3, :3].T + frame[:3, 3]
    return stiv.EditSession(topology, deformation, points, stiv.EditOptions(threads=threads))


def goal_of(step: Step, controls: NDArray[np.float64]) -> NDArray[np.float64]:
    """The goal of a step: all controls moved, or scaled about their median."""
    value = np.array(step["values"]["value"])
    if step["operator"] == "move":
        return controls + value
    centre = controls.mean(axis=0)
    return centre + (controls - centre) * value


def run(threads: int, edits: int) -> list[dict[str, Any]]:
    """Timings in seconds and counters of the first `edits` edits."""
    session = plant_session(threads)
    steps = [step for step in plant_in_vase().steps for _ in range(step["repeat"])]
    results = []
    for number, step in enumerate(steps[:edits]):
        goal = goal_of(step, session.controls)
        begin = time.process_time()
        result = session.edit(goal)
        results.append(
            {
                "processor_seconds": time.process_time() - begin,
                "edit": number,
                "status": result.status,
                "patches": result.patches,
                "contacts": len(result.events.kind),
            }
            | {"timings": result.timings, "counters": result.counters}
        )
    return results


def summary(results: list[dict[str, Any]]) -> dict[str, Any]:
    """Medians over the edits with contacts, in milliseconds per round, and sums of the counters of all edits."""
    busy = [result for result in results if result["counters"]["rounds"] > 0]

    def median(seconds: Callable[[dict[str, Any]], float]) -> float:
        values = [1000 * seconds(result) / result["counters"]["detections"] for result in busy]
        return round(statistics.median(values), 3) if values else 0.0

    def part_of(part: str) -> float:
        return median(lambda result: float(result["timings"][part]))

    return {
        "edits": len(results),
        "edits_with_response": len(busy),
        "median_ms_a_round": part_of("total"),
        "median_processor_ms_a_round": median(lambda result: float(result["processor_seconds"])),
        "median_ms_a_round_by_step": {part: part_of(part) for part in PARTS},
        "counters": {name: sum(result["counters"][name] for result in results) for name in COUNTERS},
        "patches": round(statistics.mean(result["patches"] for result in busy), 2) if busy else 0.0,
    }


def main() -> None:
    """Run the benchmark and print its summary."""
    parser = argparse.ArgumentParser(description="Milliseconds a round of the plant edit.")
    parser.add_argument("--threads", type=int, default=1, help="threads of the core (default: 1)")
    parser.add_argument("--edits", type=int, default=10_000, help="how many of the edits (default: all)")
    parser.add_argument("--json", type=Path, help="write the summary and every edit to this file")
    arguments = parser.parse_args()
    results = run(arguments.threads, arguments.edits)
    short = {"benchmark": "plant_rounds", "threads": arguments.threads, **summary(results)}
    print(json.dumps(short, indent=2))
    if arguments.json:
        arguments.json.write_text(json.dumps({**short, "each_edit": results}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
