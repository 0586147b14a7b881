# SPDX-License-Identifier: GPL-3.0-or-later
"""A replacement of `stiv.blender.BlenderEdit`: a point that stops at a wall at x = 1, and a log of the calls."""

import time
from collections.abc import Collection
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from stiv.task import Steps, Task


@dataclass(frozen=True)
class FakeResult:
    """Replaces an EditResult."""

    status: str
    path: tuple[float, ...] = ()
    energy: float = 0.0
    blocking = ()
    seconds: float = 0.0
    events: tuple[object, ...] = ()
    met: int = 0

    @property
    def counters(self) -> dict[str, int]:
        """Those of the core: a solve that accepts nothing counts events, but has none."""
        return {"events": self.met}

    @property
    def timings(self) -> dict[str, float]:
        """Those of the core."""
        return {"total": self.seconds}


@dataclass
class FakeEdit:
    """`statuses`: those of the next solves; `failing`: from the name of a call to the exception that it raises.

    `furthest`: how far one solve goes. `settling`: whether settling solves, instead of changing nothing. `delays`:
    from the name of a call to the turns that it takes. `reading`, `writing`: seconds of the start and of each write.
    `solving`: seconds that each solve reports. `budgets`, `hand_overs`: of all solves. `taking`: whether states can be
    taken from the session; `flips`: whether Blender then shows them with intersections; `cutting`: states that it shows
    with intersections. `from_start`: where the edit from the start ends, if closer to the goal. `passed`: the last
    state that was written and passed the test. `touching`: whether all solves meet an obstacle.
    """

    statuses: list[str] = field(default_factory=list)
    failing: dict[str, Exception] = field(default_factory=dict)
    delays: dict[str, int] = field(default_factory=dict)
    cancelled: bool = False
    calls: list[str] = field(default_factory=list)
    accepted: float = 0.0
    shown: float = 0.0
    goals: list[float] = field(default_factory=list)
    budgets: list[float] = field(default_factory=list)
    hand_overs: list[float | None] = field(default_factory=list)
    reading: float = 0.0
    writing: float = 0.0
    solving: float = 0.0
    taking: bool = True
    flips: bool = False
    cutting: Collection[float] = ()
    passed: float | None = None
    requests: list[Any] = field(default_factory=list)
    interference: bool = True
    moving = frozenset({"Box"})
    furthest: float = 10.0
    settling: bool = False
    from_start: float | None = None
    touching: bool = False
    busy: bool = False
    start_digest = "start"
    untested_notes: tuple[str, ...] = ()
    reset_note = passenger_note = ""
    controls = ()

    def standstill_note(self, result: Any) -> str:
        """Everything moves."""
        return ""

    @property
    def turned(self) -> float:
        """A session in a job cannot be asked."""
        if self.busy:
            raise RuntimeError("the session is in use by another call")
        return 0.0

    def begin_steps(self, request: Any) -> "Steps[FakeEdit]":
        """Replaces the beginning of an edit, of the first and of each that is requested later ("again")."""
        time.sleep(self.reading)
        yield from self._delayed("begin")
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

    def drag_steps(self, matrix: Any, *, time_budget: float, hand_over: float | None) -> "Steps[Any]":
        self.budgets.append(time_budget)
        self.hand_overs.append(hand_over)
        yield from self._delayed("drag")
        self._called("drag")
        return self._solve(matrix)

    def settle_steps(self) -> "Steps[Any]":
        yield from self._delayed("settle")
        if self.cancelled:
            return FakeResult("cancelled")
        self._called("settle")
        return self._solve(self.goals[-1]) if self.settling else FakeResult("unchanged")

    def confirm_steps(self) -> "Steps[Any]":
        yield from self._delayed("confirm")
        if self.cancelled:
            return FakeResult("cancelled")
        self._called("confirm")
        if self.from_start is None:
            return FakeResult("corrected")  # without a path: nothing better
        self.accepted = self.from_start
        return FakeResult("corrected", (self.accepted,))

    def apply_steps(self, matrix: Any, state: Any) -> "Steps[Any]":
        """Typed values: in two halves."""
        for fraction in (0.5, 1.0):
            yield fraction
            yield from self._delayed("apply")
            if self.cancelled:
                break
            self._called("apply")
            self._solve(fraction * float(matrix))
        return self, FakeResult("cancelled" if self.cancelled else "reached")

    def _delayed(self, name: str) -> "Steps[None]":
        """Take this many turns, as a job does; cancelled jobs take none."""
        for _ in range(self.delays.get(name, 0)):
            if not self.cancelled:
                self.busy = True
                yield None
                self.busy = False

    def take_state(self) -> Any:
        """Replaces taking a state; the session must be free."""
        assert not self.busy
        return SimpleNamespace(state=self.accepted, turned=0.5) if self.taking else None

    def write_taken(self, taken: Any) -> Any:
        """Replaces writing a taken state, while the session may be busy."""
        self._called("write beside" if self.busy else "write")
        time.sleep(self.writing)
        self.shown = taken.state
        if self.flips or taken.state in self.cutting:
            return None
        self.passed = taken.state
        return SimpleNamespace(passed=True, message="", result=None)

    def write_shown(self) -> bool:
        """Replaces the return to the last state that passed the test, while the session may be busy."""
        if self.passed is None:
            return False
        self._called("write shown")
        self.shown = self.passed
        return True

    def write(self) -> Any:
        assert not self.busy
        self._called("write")
        time.sleep(self.writing)
        self.shown = self.passed = self.accepted
        return None

    def write_steps(self) -> "Steps[Any]":
        yield from self._delayed("write")
        return self.write()

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
        events = (object(),) if self.touching and path else ()
        return FakeResult(status, path, (float(matrix) - self.accepted) ** 2, self.solving, events, int(self.touching))


class FakeTask(Task[Any]):
    """A task whose steps learn that they are cancelled."""

    def __init__(self, steps: Steps[Any], edit: FakeEdit) -> None:
        super().__init__(steps)
        self._edit = edit

    def cancel(self) -> None:
        self._edit.cancelled = True
        super().cancel()
