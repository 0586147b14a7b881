# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of the least distance: processor milliseconds for scenes of about 100,000 triangles.

Two balls side by side; an ellipsoid in a ball; and two concentric balls, whose triangles are all equally
close. `python -m benchmarks.least_distance`
"""

from __future__ import annotations

import time

import numpy as np

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.shape import Shape, joined


def scenes() -> dict[str, list[Shape]]:
    """Bodies of each scene, by name."""
    large, small = icosphere(6).turned((0.1, 0.2, 0.3)), icosphere(5).turned((0.3, 0.5, 0.1))
    return {
        "side by side": [large, small.moved((2.05, 0, 0))],
        "ellipsoid in a ball": [large, small.scaled((0.9, 0.8, 0.7)).moved((0.05, 0, 0))],
        "concentric": [large, small.scaled(0.9)],
    }


def main() -> None:
    """Print the table."""
    print(f"{'scene':20} {'triangles':>9} {'distance':>9} {'ms':>7} {'within too':>10}")
    for name, shapes in scenes().items():
        whole = joined(shapes)
        owner = np.repeat(np.arange(len(shapes)), [len(shape.vertices) for shape in shapes])
        bodies = [stiv.Body(str(number)) for number in range(len(shapes))]
        surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
        session = stiv.EditSession(surface, stiv.identity(len(whole.vertices)), whole.vertices)
        milliseconds = []
        for within in (False, True):
            times = []
            for _ in range(5):
                begin = time.process_time()
                session.least_distance(within=within)
                times.append(1e3 * (time.process_time() - begin))
            milliseconds.append(min(times))
        nearest = session.least_distance()
        distance = nearest.distance if nearest else float("nan")
        print(f"{name:20} {len(surface.triangles):9d} {distance:9.5f} {milliseconds[0]:7.1f} {milliseconds[1]:10.1f}")


if __name__ == "__main__":
    main()
