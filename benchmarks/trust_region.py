# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares edits of the table's sessions with the trust regions of ipctk's offset geometric contact (OGC).

A trust region bounds the displacement of each vertex by half its distance to the nearest element that it does not
share [Chen et al. 2025]: steps inside need no continuous detection. It is measured in two ways, on the culled mesh of
the race (peer_mesh.py), from the same accepted states and with our separation as the minimum distance. The region
looks as far as half an edge, or only twice the separation ("narrow").

As a filter, one update takes the place of our search for the whole step. The table shows its time, the share of the
step that all vertices may go, and the share of moving vertices whose bound covers their whole displacement: those need
no test in this step.

As a loop, the controls go the share that all vertices may go, and the region is updated there, until the goal, or a
gain below a thousandth of the motion. Bounds of single vertices cannot be used up one by one, because controls move
many. Its energy is E = 1/2 |q - q~|^2.

Usage: python -m benchmarks.trust_region [--json F]; needs ipctk 1.6 or later.
"""

from __future__ import annotations

import argparse
import importlib
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

import numpy as np

import stiv
from benchmarks.sessions.command import result
from benchmarks.sessions.peer_mesh import LinearStep, culled, peer_mesh
from benchmarks.sessions.running import Array, RecordedStage, Task, record
from benchmarks.sessions.table1 import PUBLISHED
from blend_fixtures.scenes.sessions import catalogue
from stiv import _native
from stiv.json_files import write_json

Result = TypeVar("Result")
MAX_UPDATES, LEAST_GAIN = 8, 1e-3
MAX_EDITS = 1  #: of a scene


class TrustRegion:
    """Bounds of the displacements of a step's vertices."""

    def __init__(self, peer: ModuleType, step: LinearStep, separation: float) -> None:
        self._peer, self._step = peer, step
        self._given = peer_mesh(peer, step, "culled")
        self._separation = separation
        # The radius in which the region looks for contacts. Larger ones find all neighbors, which bound more tightly.
        reach = float(np.linalg.norm(step.end - step.start, axis=1).max())
        edges = np.linalg.norm(step.start[step.triangles[:, 0]] - step.start[step.triangles[:, 1]], axis=1)
        self._offset = max(min(2 * reach, 0.5 * float(np.median(edges))), 2 * separation)
        cropped = culled(step)
        used = np.unique(cropped.triangles)
        moves = step.moves[used]
        self._rows = np.concatenate([used[moves], used[~moves]])
        self._moving = int(moves.sum())

    def bounds(self, q: Array, narrow: bool = False) -> tuple[Array, Array]:
        """Bounds of the moving vertices at a surface, (k,), and the numbers of these vertices.

        narrow: look only as far as twice the separation.
        """
        region = self._peer.ogc.TrustRegion(2 * self._separation if narrow else self._offset)
        contacts = self._peer.NormalCollisions()
        x = np.asfortranarray(q[self._rows])
        region.update(self._given.mesh, x, contacts, self._separation, self._peer.LBVH())
        radii = np.asarray(region.relaxed_radius_scaling * region.trust_region_radii)[: self._moving]
        return np.maximum(radii, 0.0), self._rows[: self._moving]


def measure(peer: ModuleType, part: RecordedStage, task: Task, separation: float) -> dict[str, float]:
    """One edit: our search, the filter, the loop, and our edit."""
    stage = part.stage
    before, wanted = (stage.deformation.surface(p) for p in (task.start, task.goal))
    motion = float(np.linalg.norm(wanted - before))
    region = TrustRegion(peer, LinearStep(stage.surface.triangles, before, wanted), separation)
    detector = stiv.Detector(stage.surface)
    detector.find(before, before, separation)  # builds its trees, as the session had
    search, _ = _timed(lambda: detector.find(before, wanted, separation))
    narrow, _ = _timed(lambda: region.bounds(before, narrow=True))
    update, (bounds, rows) = _timed(lambda: region.bounds(before))
    ahead = np.linalg.norm((wanted - before)[rows], axis=1)
    began = time.process_time()
    p, updates = _loop(stage, task, region)
    loop = time.process_time() - began
    reached = stage.deformation.surface(p)
    return {
        "search": search,
        "update": update,
        "narrow": narrow,
        "share": _share(bounds, ahead),
        "untested": float((ahead <= bounds).mean()),
        "loop": loop,
        "updates": updates,
        "kept": 1 - float(np.linalg.norm(reached - wanted)) / motion,
        "energy": 0.5 * float(((reached - wanted) ** 2).sum()),
        "intersections": len(stiv.find_intersections(reached, stage.surface)),
        "motion": motion,
    }


def _share(bounds: Array, displacements: Array) -> float:
    moving = displacements > 0
    return min(1.0, float((bounds[moving] / displacements[moving]).min(initial=1.0)))


def _loop(stage: Any, task: Task, region: TrustRegion) -> tuple[Array, int]:
    """Controls where shares of the remaining step gain less than a thousandth, and the number of updates."""
    reached = 0.0
    for updates in range(1, MAX_UPDATES + 1):
        p = task.start + reached * (task.goal - task.start)
        q, wanted = stage.deformation.surface(p), stage.deformation.surface(task.goal)
        bounds, rows = region.bounds(q)
        gain = (1 - reached) * _share(bounds, np.linalg.norm((wanted - q)[rows], axis=1))
        if gain < LEAST_GAIN:
            return p, updates
        reached += gain
    return task.start + reached * (task.goal - task.start), MAX_UPDATES


def _timed(work: Callable[[], Result]) -> tuple[float, Result]:
    """Seconds of the processor, and the result."""
    began = time.process_time()
    found = work()
    return time.process_time() - began, found


def trust_regions(names: Sequence[str]) -> list[dict[str, Any]]:
    """One row per scene: means over some edits with contacts, on one thread."""
    peer = importlib.import_module("ipctk")
    peer.set_num_threads(1)
    peer.set_logger_level(peer.off)
    rows = []
    for name in names:
        recorded, figures = record(catalogue.table_sessions()[name], {"threads": 1}, lambda note: None)
        tasks = [(part, task) for part in recorded for task in part.tasks]
        chosen = [pair for pair in zip(tasks, figures, strict=True) if pair[1].touches][:MAX_EDITS]
        both = []
        for (part, task), mine in chosen:
            stage = part.stage
            session = stiv.EditSession(stage.surface, stage.deformation, task.start, stiv.EditOptions(threads=1))
            both.append((mine, measure(peer, part, task, session.separation)))
        means = {key: float(np.mean([theirs[key] for _, theirs in both])) for key in both[0][1]}
        rows.append(
            {
                "scene": name,
                "vectors": _native.vector_target().name,
                "edits": len(both),
                "search_ms": 1000 * means["search"],
                "update_ms": 1000 * means["update"],
                "narrow_update_ms": 1000 * means["narrow"],
                "share_of_step": means["share"],
                "vertices_within_bounds": means["untested"],
                "loop_ms": 1000 * means["loop"],
                "updates": means["updates"],
                "edit_ms": 1000 * float(np.mean([mine.processor for mine, _ in both])),
                "kept_by_loop": means["kept"],
                "kept": float(np.mean([1 - np.sqrt(2 * mine.energy) / theirs["motion"] for mine, theirs in both])),
                "energy_ratio": float(np.mean([mine.energy / max(theirs["energy"], 1e-300) for mine, theirs in both])),
                "intersections": sum(mine.intersections for mine, _ in both),
                "intersections_of_loop": sum(int(theirs["intersections"]) for _, theirs in both),
            }
        )
        print(text(rows[-1:]), flush=True)
    return rows


def text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per scene."""
    return "\n".join(
        f"{r['scene']:9} search {r['search_ms']:7.1f} ms, update {r['update_ms']:7.1f} ms, narrow "
        f"{r['narrow_update_ms']:7.1f} ms, share "
        f"{r['share_of_step']:.3f}, within bounds {r['vertices_within_bounds']:.2f}; edit {r['edit_ms']:7.1f} ms, loop "
        f"{r['loop_ms']:8.1f} ms ({r['updates']:.0f}); kept {r['kept']:.3f} / {r['kept_by_loop']:.3f}, E ratio "
        f"{r['energy_ratio']:.3f}"
        for r in rows
    )


def main() -> None:
    """Measures the scenes, with vector code limited to AVX2."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.trust_region")
    parser.add_argument("--scenes", nargs="+", default=list(PUBLISHED))
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    _native.limit_vector_target(_native.VectorTarget.avx2)
    rows = []
    for name in arguments.scenes:
        rows += trust_regions([name])
        if arguments.json is not None:
            write_json(arguments.json, result(rows))


if __name__ == "__main__":
    main()
