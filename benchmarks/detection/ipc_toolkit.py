# SPDX-License-Identifier: GPL-3.0-or-later
"""The peer: detection of one step by ipctk [Ferguson et al. 2020], its fastest broad phase with both narrow
phases.

Its documentation describes how to reduce its input; see benchmarks.sessions.peer_mesh for the settings.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

from benchmarks.sessions.peer_mesh import LinearStep, peer_mesh
from blend_fixtures.scenes.detection_steps import Step

NARROW_PHASES = ("additive", "tight inclusion")


class Peer:
    """One step prepared for ipctk: its mesh and column-major positions, which are not timed."""

    def __init__(self, ipctk: ModuleType, step: Step, threads: int, setting: str = "everything") -> None:
        ipctk.set_num_threads(threads)
        ipctk.set_logger_level(ipctk.off)
        self._ipctk = ipctk
        self._step, self._setting = LinearStep(step.triangles, step.start, step.end), setting
        self.build_mesh()
        self._narrow = dict(zip(NARROW_PHASES, (ipctk.AdditiveCCD(), ipctk.TightInclusionCCD()), strict=True))
        self._candidates = ipctk.Candidates()

    def build_mesh(self) -> None:
        """Cull and order the triangles for the setting, and create the peer's mesh."""
        given = peer_mesh(self._ipctk, self._step, self._setting)
        self._mesh, self._start, self._end = given.mesh, given.start, given.end

    def find_candidates(self) -> None:
        """Broad phase: all vertex-face and edge-edge pairs whose swept boxes overlap."""
        self._candidates = self._ipctk.Candidates()
        self._candidates.build(self._mesh, self._start, self._end, 0, self._ipctk.LBVH())

    def earliest_time(self, narrow_phase: str) -> float:
        """Narrow phase over the candidates: only the earliest time; later pairs are skipped."""
        time: float = self._candidates.compute_collision_free_stepsize(
            self._mesh, self._start, self._end, 0, self._narrow[narrow_phase]
        )
        return time

    @property
    def candidate_count(self) -> int:
        """Number of pairs that the broad phase found."""
        return len(self._candidates.fv_candidates) + len(self._candidates.ee_candidates)

    def hits(self, narrow_phase: str) -> Iterator[tuple[str, list[int]]]:
        """Candidates that collide within the step, each tested separately (slow): kind and the four vertices."""
        mesh, ccd = self._mesh, self._narrow[narrow_phase]
        for kind, candidates in (("vf", self._candidates.fv_candidates), ("ee", self._candidates.ee_candidates)):
            for pair in candidates:
                ends = [pair.dof(positions, mesh.edges, mesh.faces) for positions in (self._start, self._end)]
                if pair.ccd(*ends, 0.0, 1.0, ccd)[0]:
                    yield kind, pair.vertex_ids(mesh.edges, mesh.faces)


def load() -> ModuleType | None:
    """ipctk, or None after printing how to install it."""
    try:
        import ipctk
    except ImportError:
        print("ipctk is not installed, its columns stay empty: pip install -r tools/requirements/bench.txt")
        return None
    module: ModuleType = ipctk
    return module
