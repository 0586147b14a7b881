# SPDX-License-Identifier: GPL-3.0-or-later
"""The method as published, as a set of options, and how the defaults differ from it.

"Interference-Aware Geometric Modeling", Harmon, Panozzo, Sorkine, Zorin, 2011.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

#: The options of :meth:`stiv.EditOptions.paper`: Algorithm 1, with a constraint for each patch.
PAPER_OPTIONS: Mapping[str, Any] = {
    "volumes": "published",  # Eq. 3, by each side's own motion; the full gradient of Appendix A
    "metric": "controls",  # steps along the gradient in the controls
    "narrow_phase": "polynomial",  # roots of polynomials of degree 3, or 6 with a separation; 1/100 early
    "accumulated_rounds": 0,  # each round responds to its own contacts
    "max_sub_edits": 1,  # one run of Algorithm 1
    "pull_limit": 0.0,  # a drag only applies its increments
}

#: Corrections of the published method and their reasons, for comparisons.
PAPER_DIFFERENCES = """\
The preset "paper" is the method as published. The defaults differ from it as follows.
- Volume. Published: (1 - t) n . Dr of each side's own motion [Eq. 1, 3]. Default: of the relative motion of both sides.
  The published form stops sides that touch and move together, and a side at rest never responds.
- Gradient. Published: of time, weights and normal [Appendix A], by the vertices of both sides. Its term of dt/dq lacks
  the factor -t / (n . Drho), which the preset has. Default: of the time alone, w n. It omits the rotation of the
  contact plane, which a single grazing contact would dominate.
- Metric. Published: the step has minimum norm in the controls [Algorithm 1]. Default: in the energy E.
- Margin. Published: times are 1/100 early [4.1]. Default: a minimum distance h above the rounding error of storage.
- Detection. Published: roots of polynomials of degree 3, or 6 for distances of planes and lines [4.1, 5.2]. Default:
  conservative advancement with distances of faces and edges, which misses no contact at a boundary or corner.
- Patches. Published: connected by neighboring vertices [4.1]. Default: also by common contacts, so both sides are one.
- Rounds. Published: each round responds to its own contacts. Default: constraints stay for several rounds, single
  contacts become constraints of their own, and the solution is solved again from its result. Drags are also pulled
  toward their goal.
The preset differs from the publication as follows.
- Acceptance. A state is only accepted after the conservative test of its path and the exact test of its surface, with
  the numbers that are stored. If the method leaves intersections, or does not end in 60 rounds, the edit stops early.
- Weights are in the step as well as in the denominator [5.2 has only the latter]. Otherwise pinned controls would move.
"""
