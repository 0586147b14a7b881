# SPDX-License-Identifier: GPL-3.0-or-later
"""The results as printed: their tables are those of the measured files, and hold what the text says of them."""

import pytest

from benchmarks.results_tables.__main__ import filled
from benchmarks.results_tables.markdown import FOLDER, loaded
from benchmarks.sessions.table1 import PUBLISHED


def test_the_tables_of_the_results_are_those_of_the_files():
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert filled(text) == text


@pytest.mark.parametrize("scene", PUBLISHED)
def test_the_measured_table_has_at_least_the_papers_contacts_in_every_row(scene):
    rows = [row for row in loaded("table1")["rows"] if row["scene"] == scene]
    assert {row["preset"] for row in rows} == {"stiv", "paper", "paper_frozen"}
    for row in rows:
        assert row["collisions"] >= PUBLISHED[scene]["collisions"]
        assert row["step"] > 0 and row["intersections"] == 0


def test_the_whole_gradient_is_the_harder_baseline_of_the_two():
    """Geometric means over a stop at the first contact; 1.39 is what the frozen gradient came to before."""
    means = loaded("paper_preset")["means"]
    assert means["frozen, LCP"] == pytest.approx(1.39, abs=0.01)
    assert means["settled"] < means["ours"] < means["paper, LCP"] < means["frozen, LCP"]
    drags = loaded("whole_drags")["means"]
    assert drags["best"] <= drags["settled"] <= drags["one edit"] < drags["paper"] < drags["frozen"]
