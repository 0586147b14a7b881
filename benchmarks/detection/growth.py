# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth of the time and memory of one detection with the number of triangles, each size in its own process."""

from __future__ import annotations

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from blend_fixtures.scenes.detection_steps import growing
from stiv.batch.peak_memory import peak_bytes

from .measurement import measure

CUTS = (20, 40, 79, 158, 224)  #: 24 cuts^2 triangles: 9,600 to 1.2 million


@dataclass(frozen=True)
class Size:
    """One size: milliseconds of a full detection, and the peak memory of its process."""

    triangles: int
    hits: int
    first: float
    megabytes: float  #: of the interpreter, the arrays of the scene and the detector
    before: float  #: of these, the memory before the detector was created


def _held() -> float:
    return peak_bytes() / 2**20


def one_size(cuts: int, threads: int, repeats: int) -> Size:
    """Measure in this process."""
    step = growing(cuts)
    before = _held()
    figures = measure(step, threads, repeats, None)
    return Size(figures.triangles, figures.hits, figures.first, _held(), before)


def all_sizes(threads: int, repeats: int) -> list[Size]:
    """Measure each size in its own process, to separate the memory."""
    context = multiprocessing.get_context("spawn")
    sizes = []
    for cuts in CUTS:
        with ProcessPoolExecutor(1, mp_context=context) as pool:
            sizes.append(pool.submit(one_size, cuts, threads, repeats).result())
    return sizes


def exponent(sizes: list[Size]) -> float:
    """Slope of log time over log triangles: 1 is proportional."""
    slope, _ = np.polyfit(np.log([s.triangles for s in sizes]), np.log([s.first for s in sizes]), 1)
    return float(slope)
