# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags in Blender: how long each tick blocks the interface, and the delay of the displayed state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

DragsOf = Callable[[Path, int], Sequence[Any]]
TICK_VALUES = ("at", "seconds", "solving", "shown", "behind", "touches")


def dragged_rows(path: Path, drags_of: DragsOf, threads: Sequence[int]) -> tuple[list[dict[str, Any]], int]:
    """A row for each number of threads, in wall time, and the number of displayed states that failed the test.

    drags_of: opens a .blend, drags its script with this number of threads, and returns each `DraggedStage`.
    """
    rows, failed = [], 0
    for count in threads:
        stages = drags_of(path, count)
        failed += sum(not tick.passed for stage in stages for tick in stage.ticks)
        rows.append({"threads": count, "stages": [_stage(stage) for stage in stages]})
    return rows, failed


def _stage(stage: Any) -> dict[str, Any]:
    values = {name: getattr(stage, name) for name in ("name", "beginning", "moving", "settling", "confirming")}
    return {**values, "ticks": {name: [getattr(tick, name) for tick in stage.ticks] for name in TICK_VALUES}}


def shapes_a_second(stage: dict[str, Any]) -> tuple[float, float]:
    """New shapes shown a second while the mouse moved: the least over any second, and the median of 1 / distance."""
    at, span = _while_moving(stage, "at"), min(1.0, stage["moving"])
    starts = np.concatenate([[0.0], at[at <= stage["moving"] - span]])
    counts = [np.count_nonzero((at > start) & (at <= start + span)) for start in starts]
    return min(counts) / span, float(1.0 / np.median(shown_apart(stage)))


def frames_missed(stage: dict[str, Any], rate: float = 60.0) -> int:
    """Most consecutive frames at this rate without a new shape, while the mouse moved."""
    ends = np.append(_while_moving(stage, "at"), stage["moving"])
    return max(0, int(np.round(rate * np.diff(ends, prepend=0.0).max())) - 1)


def dragged_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per scene and number of threads, in milliseconds.

    "ticks", "apart" and "behind" are maximum / 95 % / median: of the time that a tick blocks the interface,
    of the time between displayed states while the mouse moves, and of their delay behind the mouse. "shapes"
    are those shown a second, least over a second / median; "missed" are the most frames in a row without one.
    """
    head = (
        f"{'as dragged':10} {'threads':>7} {'shapes':>9} {'missed':>6} {'ticks':>17} {'apart':>17} {'behind':>17}"
        f" {'settling':>8} {'begin':>6}"
    )
    return "\n".join([head, *(_line(row["scene"], part) for row in rows for part in row["dragged"])])


def _line(scene: str, part: dict[str, Any]) -> str:
    figures = drag_figures(part["stages"])
    spreads = " ".join(f"{text:>17}" for text in (figures.ticks, figures.apart, figures.behind))
    shapes = f"{figures.least:.0f} / {figures.median:.0f}"
    return (
        f"{scene:10} {part['threads']:7d} {shapes:>9} {figures.missed:6d} {spreads} {figures.settling:8.0f}"
        f" {figures.beginning:6.0f}"
    )


@dataclass(frozen=True)
class DragFigures:
    """Figures of all drags of a scene.

    Attributes:
        least, mean, median: new shapes a second while the mouse moved: the least over any second, the mean, and the
            inverse of the median distance.
        missed: see `frames_missed`.
        ticks, apart, behind: as in `dragged_text`.
        beginning, settling, confirming: longest, in milliseconds.
    """

    least: float
    mean: float
    median: float
    missed: int
    ticks: str
    apart: str
    behind: str
    beginning: float
    settling: float
    confirming: float


def drag_figures(stages: Sequence[dict[str, Any]]) -> DragFigures:
    """The figures of the stages of one scene, with one number of threads."""
    apart = np.concatenate([shown_apart(stage) for stage in stages])
    ticks = np.concatenate([stage["ticks"]["seconds"] for stage in stages])
    behind = np.concatenate([_while_moving(stage, "behind") for stage in stages])
    longest = {what: 1000 * max(stage[what] for stage in stages) for what in ("beginning", "settling", "confirming")}
    return DragFigures(
        least=min(shapes_a_second(stage)[0] for stage in stages),
        mean=len(apart) / sum(stage["moving"] for stage in stages),
        median=float(1.0 / np.median(apart)),
        missed=max(map(frames_missed, stages)),
        ticks=_percentiles(ticks),
        apart=_percentiles(apart),
        behind=_percentiles(behind),
        **longest,
    )


def shown_apart(stage: dict[str, Any]) -> Any:
    """Seconds between consecutive displayed states while the mouse moved."""
    return np.diff(_while_moving(stage, "at"), prepend=0.0)


def _while_moving(stage: dict[str, Any], name: str) -> Any:
    ticks = {key: np.array(values) for key, values in stage["ticks"].items()}
    rows = ticks["shown"].astype(bool) & (ticks["at"] <= stage["moving"])
    return ticks[name][rows] if rows.any() else np.array([stage["moving"] + stage["settling"]])


def _percentiles(seconds: Any) -> str:
    worst, most, median = 1000 * np.percentile(seconds, [100, 95, 50])
    return f"{worst:.0f} / {most:.0f} / {median:.0f}"
