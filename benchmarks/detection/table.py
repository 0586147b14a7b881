# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the race, one line per step."""

from __future__ import annotations

from .measurement import Figures

HEADER = (
    f"{'scene':18} {'triangles':>9} {'threads':>7} {'vectors':>8} {'hits':>7} |"
    f" {'build':>8} {'first':>8} {'again':>8} |"
    f" {'all':>8} {'at best':>8} {'setting':10} {'mesh':>8} | {'all/first':>9} {'best/first':>10} {'all/build':>9}"
    f" {'(all+mesh)/build':>16} {'first/again':>11}"
)


def line(figures: Figures) -> str:
    """One step; milliseconds."""
    left = f"{figures.scene:18} {figures.triangles:9,} {figures.threads:7} {figures.vectors:>8} {figures.hits:7,} |"
    ours = f" {figures.build:8.1f} {figures.first:8.1f} {figures.again:8.1f} |"
    rounds = f"{figures.first / figures.again:11.1f}"
    if not figures.peer:
        return f"{left}{ours} {'-':>8} {'-':>8} {'-':10} {'-':>8} | {'-':>9} {'-':>10} {'-':>9} {'-':>16} {rounds}"
    setting, best = figures.peer_best
    everything = figures.peer["everything"]
    whole = everything.best[1]
    return (
        f"{left}{ours} {whole:8.1f} {best:8.1f} {setting:10} {figures.peer[setting].mesh:8.1f} |"
        f" {whole / figures.first:9.1f} {best / figures.first:10.1f} {whole / figures.build:9.1f}"
        f" {(whole + everything.mesh) / figures.build:16.1f} {rounds}"
    )
