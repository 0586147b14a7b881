# SPDX-License-Identifier: GPL-3.0-or-later
"""Published collision queries with exact answers: a sample, and all queries next to the repository."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import stiv
from tests.detection.published_queries import KINDS, read
from tests.oracles.first_contact import WIDTH, first_contact, squared_distance

SAMPLE = Path(__file__).with_name("sample_queries")
BESIDE = Path(__file__).parents[3] / "shared" / "ccd_queries"
"""More of them, if the folder is there; its README gives the format."""
FILES = [path for folder in (SAMPLE, BESIDE) for path in sorted(folder.glob("*/*/*.csv"))]
CONTACTS, MISSES = 231, 137
"""In the sample."""
NOT_BESIDE = pytest.mark.skipif(not BESIDE.is_dir(), reason="no ../shared/ccd_queries beside the repository")


ACCEPTED_FALSE = 0.031
"""Of all queries: those of Tight-Inclusion in C++ on the whole published set (Wang et al. 2021, table 1)."""


def test_the_sample_holds_all_contacts_and_some_misses() -> None:
    answers = [answer for path in SAMPLE.glob("*/*/*.csv") for answer in read(path)[1]]
    assert (len(answers), sum(answers)) == (CONTACTS + MISSES, CONTACTS)


@pytest.mark.parametrize("folder", [SAMPLE, pytest.param(BESIDE, marks=NOT_BESIDE)], ids=lambda path: path.name)
def test_few_near_misses_are_reported(folder: Path) -> None:
    count = false = 0
    for path in sorted(folder.glob("*/*/*.csv")):
        queries, answers = read(path)
        points = np.array(queries, dtype=float)
        times = stiv.time_of_impact(KINDS[path.parent.name], points[:, :4], points[:, 4:])
        count += len(answers)
        false += int(np.sum(np.isfinite(times) & ~np.array(answers)))
    print(f"{false} of {count} queries are reported and do not meet")
    assert count > 0
    assert false <= ACCEPTED_FALSE * count


@pytest.mark.parametrize("path", FILES, ids=lambda path: "-".join(path.parts[-4:]))
def test_no_query_is_missed_and_none_is_late(path: Path) -> None:
    kind = KINDS[path.parent.name]
    queries, answers = read(path)
    points = np.array(queries, dtype=float)
    times = stiv.time_of_impact(kind, points[:, :4], points[:, 4:])
    found, meets = np.isfinite(times), np.array(answers)
    assert not np.any(meets & ~found), "missed"
    early = []
    for row in np.flatnonzero(found):
        truth = first_contact(kind, queries[row][:4], queries[row][4:])
        assert (truth is not None) == meets[row]
        if truth is None:
            assert relative_distance(kind, queries[row], times[row]) < 2**-44, f"query {row} is not in contact"
        else:
            assert Fraction(times[row]) <= truth + WIDTH, f"query {row} is late"
            early.append(float(truth) - times[row])
    assert np.median(early or [0.0]) < 1e-3
    print(f"{len(meets)} queries, {np.sum(meets)} meet, {np.sum(found & ~meets)} nearer than rounding")


def relative_distance(kind: str, points: list[list[Fraction]], time: float) -> float:
    """Distance at a time, relative to the largest coordinate."""
    t = Fraction(time)
    at_time = [tuple((1 - t) * a + t * b for a, b in zip(points[k], points[k + 4], strict=True)) for k in range(4)]
    size = max(abs(c) for point in points for c in point)
    return float(squared_distance(kind, at_time) / size**2) ** 0.5
