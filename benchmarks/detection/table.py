# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the race, one line a step."""

from __future__ import annotations

from .measurement import Figures

HEADER = (
    f"{'scene':18} {'triangles':>9} {'threads':>7} {'vectors':>8} {'candidates':>10} {'hits':>7} |"
    f" {'build':>8} {'first':>8} {'again':>8} |"
    f" {'broad':>8} {'earliest':>8} {'narrow phase':15} | {'earliest/first':>14} {'first/again':>11}"
)


def line(figures: Figures) -> str:
    """One step; milliseconds."""
    left = f"{figures.scene:18} {figures.triangles:9,} {figures.threads:7} {figures.vectors:>8} "
    left += f"{'-' if figures.candidates is None else f'{figures.candidates:,}':>10} {figures.hits:7,} |"
    ours = f" {figures.build:8.1f} {figures.first:8.1f} {figures.again:8.1f} |"
    rounds = f"{figures.first / figures.again:11.1f}"
    best = figures.peer_best
    if best is None:
        return f"{left}{ours} {'-':>8} {'-':>8} {'-':15} | {'-':>14} {rounds}"
    name, milliseconds = best
    return (
        f"{left}{ours} {figures.peer_broad:8.1f} {milliseconds:8.1f} {name:15} |"
        f" {milliseconds / figures.first:14.1f} {rounds}"
    )
