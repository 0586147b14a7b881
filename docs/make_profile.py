# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws frames a second over sessions, as the paper's Figure 12, from what `stiv bench profile --json F` wrote.

python docs/make_profile.py F [--output docs/gallery/profile.png]
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")

from matplotlib import pyplot, ticker

ROOT = Path(__file__).resolve().parents[1]


def draw(rows: list[dict], output: Path) -> None:
    """One graph a session; stages are told apart by dashed lines, interactive is what lies above 24."""
    figure, axes = pyplot.subplots(len(rows), 1, figsize=(7, 1.9 * len(rows)), layout="constrained", squeeze=False)
    for row, axis in zip(rows, axes[:, 0], strict=True):
        rates = 1 / np.array(row["seconds"])
        axis.semilogy(np.arange(1, len(rates) + 1), rates, lw=1.2, color="#c05a1c")
        axis.axhline(24, color="#888888", lw=0.8, ls=":")
        changes = [k for k in range(1, len(rates)) if row["stages"][k] != row["stages"][k - 1]]
        for change in changes:
            axis.axvline(change + 0.5, color="#aaaaaa", lw=0.8, ls="--")
        axis.set_title(f"{row['scene']}: edits a second, {row['time']} time, {row['threads']} thread(s)", fontsize=9)
        axis.set_xlabel("edit", fontsize=8)
        axis.tick_params(labelsize=8)
        axis.yaxis.set_major_formatter(ticker.ScalarFormatter())
        axis.yaxis.set_minor_formatter(ticker.NullFormatter())
        axis.margins(x=0.01)
    figure.savefig(output, dpi=110)


def main() -> None:
    """Draws what a file holds."""
    parser = argparse.ArgumentParser(description="Draw frames a second over sessions.")
    parser.add_argument("profile", type=Path, help="written by stiv bench profile --json")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "gallery" / "profile.png")
    arguments = parser.parse_args()
    draw(json.loads(arguments.profile.read_text(encoding="utf-8"))["rows"], arguments.output)


if __name__ == "__main__":
    main()
