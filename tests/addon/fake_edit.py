# SPDX-License-Identifier: GPL-3.0-or-later
"""A replacement of `stiv.blender.BlenderEdit`: a point that stops at a wall at x = 1, and a log of the calls."""

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any


@dataclass
class FakeEdit:
    """`statuses`: those of the next solves; `failing`: from the name of a call to the exception that it raises.

    `furthest`: how far one solve goes.
    """

    statuses: list[str] = field(default_factory=list)
    failing: dict[str, Exception] = field(default_factory=dict)
    calls: list[str] = field(default_factory=list)
    accepted: float = 0.0
    shown: float = 0.0
    goals: list[float] = field(default_factory=list)
    requests: list[Any] = field(default_factory=list)
    interference: bool = True
    moving = frozenset({"Box"})
    furthest: float = 10.0
    turned = 0.0
    start_digest = "start"
    controls = ()

    def begun(self, request: Any) -> "FakeEdit":
        """Replaces the beginning of an edit, of the first and of each that is requested later ("again")."""
        for name in ("begin", "again") if self.requests else ():
            if name in self.failing:
                raise self.failing[name]
        self.requests.append(request)
        self.interference = request.interference
        return self

    def set_interference(self, on: bool) -> str:
        self._called("interference")
        self.interference = on
        return ""

    def drag(self, matrix: Any, *, time_budget: float) -> Any:
        assert time_budget > 0
        self._called("drag")
        return self._solve(matrix)

    def settle(self) -> Any:
        self._called("settle")
        return SimpleNamespace(status="unchanged", blocking=())

    def write(self) -> Any:
        self._called("write")
        self.shown = self.accepted
        return None

    def restore(self) -> None:
        self._called("restore")
        self.accepted = self.shown = 0.0

    def _called(self, name: str) -> None:
        self.calls.append(name)
        if name in self.failing:
            raise self.failing[name]

    def _solve(self, matrix: Any) -> Any:
        self.goals.append(float(matrix))
        self.accepted = min(float(matrix), 1.0, self.accepted + self.furthest)
        status = self.statuses.pop(0) if self.statuses else "reached"
        path = (self.accepted,) if self.furthest > 0 else ()
        energy, timings = (float(matrix) - self.accepted) ** 2, {"total": 0.0}
        return SimpleNamespace(status=status, blocking=(), energy=energy, path=path, timings=timings)
