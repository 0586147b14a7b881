# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of impact of single pairs: correctness by exact arithmetic, and the cost of a query.

Random and adversarial queries of ten kinds (the long form of tests/detection/test_random_queries.py), and the
published ones of Wang et al. 2021 if their folder is named. Early: how much before the exact time.
Microseconds per query on one thread: over a whole array, and the median and maximum over arrays that repeat
one query.

`python -m benchmarks.time_of_impact [--count N] [--seed S] [--queries FOLDER]`
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from tests.detection.awkward_queries import SORTS, Points, make
from tests.detection.published_queries import KINDS, read
from tests.oracles.first_contact import WIDTH, first_contact

COPIES = 64


@dataclass
class Account:
    """Results of several queries."""

    count: int = 0
    contacts: int = 0
    missed: int = 0
    late: int = 0
    made_up: int = 0
    early: list[float] = field(default_factory=list)

    def add(self, found: float, truth: Fraction | None) -> None:
        """Compare a time with the exact one; None: no contact."""
        self.count += 1
        self.contacts += truth is not None
        if truth is None:
            self.made_up += bool(np.isfinite(found))
        elif not np.isfinite(found):
            self.missed += 1
        else:
            self.late += Fraction(found) > truth + WIDTH
            self.early.append(float(truth) - found)

    def __str__(self) -> str:
        """One line."""
        early = np.array(self.early or [0.0])
        return (
            f"{self.count:6} queries {self.contacts:6} contacts {self.missed:3} missed {self.late:3} late"
            f" {self.made_up:4} made up; early {np.median(early):7.1e} (median) {early.max():7.1e} (most)"
        )


def impacts(kind: str, points: Points) -> NDArray[np.float64]:
    """Return the times found by the library."""
    return stiv.time_of_impact(kind, points[:, :4], points[:, 4:], threads=1)


def seconds(kind: str, points: Points, repeats: int) -> float:
    """Return the minimum time of a call for the whole array."""
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        impacts(kind, points)
        best = min(best, time.perf_counter() - start)
    return best


def random_queries(count: int, seed: int) -> None:
    """Print a line for each kind of query and pair."""
    for sort in SORTS:
        for kind in ("vf", "ee"):
            points, account = make(sort, count, seed), Account()
            for query, found in zip(points.tolist(), impacts(kind, points), strict=True):
                account.add(found, first_contact(kind, query[:4], query[4:]))
            print(f"{sort:16} {kind} {account}; {1e6 * seconds(kind, points, 3) / count:6.2f} us", flush=True)


def published_queries(folder: Path) -> None:
    """Print the combined account of all files."""
    account, whole, single = Account(), 0.0, []
    for path in sorted(folder.glob("*/*/*.csv")):
        kind = KINDS[path.parent.name]
        queries, _ = read(path)
        points = np.array(queries, dtype=float)
        for query, found in zip(queries, impacts(kind, points), strict=True):
            account.add(found, first_contact(kind, query[:4], query[4:]))
        whole += seconds(kind, points, 5)
        single += [
            seconds(kind, np.repeat(points[row : row + 1], COPIES, axis=0), 3) / COPIES for row in range(len(points))
        ]
    print(f"published           {account}")
    median, mean, most = (1e6 * figure(single) for figure in (np.median, np.mean, np.max))
    print(f"  {100 * account.made_up / account.count:.2f} % made up")
    print(f"  microseconds a query: {1e6 * whole / account.count:.2f} of whole arrays")
    print(f"  microseconds of each: {median:.2f} median, {mean:.2f} mean, {most:.1f} most")


def main() -> None:
    """Read the command line and print the lines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=10000, help="random queries of each sort and kind, default: 10000")
    parser.add_argument("--seed", type=int, default=1, help="default: 1")
    parser.add_argument(
        "--queries", type=Path, help="folder of published queries, in the format of tests/detection/sample_queries"
    )
    arguments = parser.parse_args()
    if arguments.queries:
        published_queries(arguments.queries)
    if arguments.count:
        random_queries(arguments.count, arguments.seed)


if __name__ == "__main__":
    main()
