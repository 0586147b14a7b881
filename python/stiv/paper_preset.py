# SPDX-License-Identifier: GPL-3.0-or-later
"""The method as published, as a set of options, and what the defaults do otherwise.

"Interference-Aware Geometric Modeling", Harmon, Panozzo, Sorkine, Zorin, 2011.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

#: What :meth:`stiv.EditOptions.paper` sets: Algorithm 1 from start to end, with a constraint for each patch.
PAPER_OPTIONS: Mapping[str, Any] = {
    "volumes": "published",  # Eq. 3, each side by its own motion; the whole gradient of Appendix A
    "metric": "controls",  # steps along the gradient by the controls
    "narrow_phase": "polynomial",  # roots of cubics, of degree six with a separation; 1/100 early
    "accumulated_rounds": 0,  # each round answers what it found itself
    "max_sub_edits": 1,  # one run of Algorithm 1
    "pull_limit": 0.0,  # a drag is its increments
}

#: What was corrected in the published method and why, for whoever compares: print it beside a table.
PAPER_DIFFERENCES = """\
The preset "paper" is the method as published; the defaults differ from it in this:
- Volume. Published: (1 - t) n . Dr of each side's own motion [Eq. 1, 3]. Default: of both sides' relative motion.
  The published form stops what moves together with something that it meets, and never answers by a side at rest.
- Gradient. Published: of time, weights and normal [Appendix A], by the vertices of both sides; its term of dt/dq lacks
  its scale, -t / (n . Drho), which the preset has. Default: of the time alone, w n: the rotation of the contact plane
  is left out, which a single grazing contact would own.
- Metric. Published: the step is shortest in the controls [Algorithm 1]. Default: in the energy E that is to be least.
- Margin. Published: times 1/100 early [4.1]. Default: a distance h that is kept, never below what is stored can tell.
- Detection. Published: roots of cubics, or of a polynomial of degree six that knows planes and lines only [4.1, 5.2].
  Default: distances of whole faces and edges, advanced conservatively: no contact at a border or corner is missed.
- Patches. Published: joined by neighbouring vertices [4.1]. Default: by common contacts too: both sides are one.
- Rounds. Published: each answers what it finds. Default: constraints are kept for some rounds, single contacts become
  constraints of their own, and answers are solved again from where they ended. Drags are also pulled to their goal.
What the preset does not take from the publication:
- Acceptance. No state is accepted but after the conservative test of its way and the exact test of its surface, on the
  numbers that are stored. Where the method leaves intersections, or does not end in 60 rounds, the edit stops short.
- Weights stand in the step as well as in the denominator [5.2 has the latter only], or pinned controls would move.
"""
