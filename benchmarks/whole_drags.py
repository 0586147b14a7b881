# SPDX-License-Identifier: GPL-3.0-or-later
"""Deep goals: each stage of Table 1's sessions as one edit to the end of its whole drag, deep inside the
obstacle.

The goal is the end of all edits of a stage without obstacles. E = 1/2 |f(p) - f(goal)|^2, relative to a stop
at the first contact, by these methods:

    paper, frozen  one edit by `EditOptions.paper` and `EditOptions.paper_frozen`
    one edit       by the defaults
    settled        the same, settled until nothing changes
dragged        the defaults, dragged like a mouse through the edits of the stage, with absolute goals
    best           the minimum of these, and of the settled results of the paper and of the drag

`python -m benchmarks.whole_drags [--scenes NAME ...] [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import stiv
from benchmarks.sessions.running import Preset, solver_of, step_size
from blend_fixtures.scenes.sessions.catalogue import table_sessions
from blend_fixtures.scenes.sessions.session import Session, Stage

from .settling import Array, geometric_mean, settle, settle_from, stopped_energy

WAYS = ("paper", "frozen", "one edit", "settled", "dragged", "best")


@dataclass(frozen=True)
class Drag:
    """Whole drag of one stage; energies relative to a stop at the first contact."""

    scene: str
    stage: str
    step: float  #: largest requested motion of a vertex, in diagonals of the movable surface
    stopped: float  #: energy, world units squared
    energies: dict[str, float]
    rounds: dict[str, int]
    contacts: float  #: per round of our single edit
    still: bool  #: settling ended because nothing changed
    intersections: int


def goals(stage: Stage) -> list[Array]:
    """Controls after each edit of a stage without obstacles."""
    places = [stage.controls]
    for edit in stage.edits:
        places.append(edit(places[-1]))
    return places[1:]


def measure(name: str, stage: Stage, calls: int) -> tuple[Drag | None, Array]:
    """Solve a stage's drag by all methods (None without contacts); also returns the dragged controls."""
    ends = goals(stage)
    start, goal = (stage.deformation.surface(p) for p in (stage.controls, ends[-1]))
    dragged = solver_of(stage, {})
    for end in ends:
        last = dragged.drag(end)
    controls = dragged.controls
    stopped = stopped_energy(stage.surface, start, goal, dragged.separation)
    if stopped == 0:
        return None, controls
    answers = {way: one_edit(stage, ends[-1], preset) for way, preset in PRESETS.items()}
    solver = solver_of(stage, {})
    answers["one edit"] = solver.edit(ends[-1])
    settled = settle(solver, answers["one edit"].energy, calls)
    others = [settle_from(solver, p, ends[-1], calls) for p in (answers["paper"].controls, controls)]
    energies = {way: answer.energy for way, answer in answers.items()}
    energies |= {"settled": settled.energy, "dragged": last.energy}
    energies["best"] = min(*energies.values(), *(other.energy for other in others))
    ours = answers["one edit"]
    drag = Drag(
        name,
        stage.name,
        step_size(start, goal),
        stopped,
        {way: energies[way] / stopped for way in WAYS},
        {way: answer.rounds for way, answer in answers.items()},
        ours.counters["events"] / max(ours.rounds, 1),
        settled.calls < calls,
        sum(len(stiv.find_intersections(answer.surface, stage.surface)) for answer in (*answers.values(), last)),
    )
    return drag, controls


PRESETS: dict[str, Preset] = {"paper": stiv.EditOptions.paper, "frozen": stiv.EditOptions.paper_frozen}


def one_edit(stage: Stage, goal: Array, preset: Preset) -> stiv.EditResult:
    """One edit from the start of a stage."""
    return solver_of(stage, {}, preset).edit(goal)


def drags(session: Session, calls: int) -> Iterator[Drag]:
    """The whole drags of a session, stage by stage, each from the dragged result of the previous one."""
    stages = session.stages()
    stage = next(stages)
    while True:
        drag, controls = measure(session.name, stage, calls)
        if drag:
            yield drag
        try:
            stage = stages.send(controls)
        except StopIteration:
            return


def line(drag: Drag) -> str:
    """One stage."""
    energies = " ".join(f"{drag.energies[way]:9.4f}" for way in WAYS)
    name = f"{drag.scene}: {drag.stage}"
    return (
        f"{name:36} {100 * drag.step:6.1f}% {drag.contacts:8.1f} {energies}  {'' if drag.still else 'still changing'}"
    )


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    sessions = table_sessions()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=[*sessions], default=[*sessions], help="default: all")
    parser.add_argument("--calls", type=int, default=20, help="of settle, at most (default: 20)")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    print(f"{'drag':36} {'step':>7} {'contacts':>8} " + " ".join(f"{way:>9}" for way in WAYS))
    found = []
    for name in arguments.scenes:
        for drag in drags(sessions[name], arguments.calls):
            found.append(drag)
            print(line(drag), flush=True)
    means = {way: geometric_mean([drag.energies[way] for drag in found]) for way in WAYS}
    print(f"{'geometric mean':52} " + " ".join(f"{means[way]:9.4f}" for way in WAYS))
    print(f"intersections in all answers: {sum(drag.intersections for drag in found)}")
    if arguments.json:
        content = {"drags": [asdict(drag) for drag in found], "means": means}
        arguments.json.write_text(json.dumps(content, indent=2) + "\n")


if __name__ == "__main__":
    main()
