# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw frames per second over sessions, like the paper's Figure 12, from the output of `stiv bench profile
--json F`.

python docs/make_profile.py F [F ...] [--scenes NAME ...] [--output docs/gallery/profile.png]
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
    """One graph per session with a line for each row; dashed lines separate stages, the dotted line marks 24."""
    names = list(dict.fromkeys(row["scene"] for row in rows))
    figure, axes = pyplot.subplots(len(names), 1, figsize=(7, 2.1 * len(names)), layout="constrained", squeeze=False)
    for name, axis in zip(names, axes[:, 0], strict=True):
        of = [row for row in rows if row["scene"] == name]
        for row in of:
            _draw_row(axis, row)
        axis.axhline(24, color="#888888", lw=0.8, ls=":")
        axis.set_title(f"{name}: frames a second, {of[0]['threads']} thread(s)", fontsize=9)
        axis.set_xlabel("edit", fontsize=8)
        axis.tick_params(labelsize=8)
        axis.yaxis.set_major_formatter(ticker.ScalarFormatter())
        axis.yaxis.set_minor_formatter(ticker.NullFormatter())
        axis.margins(x=0.01)
        axis.legend(fontsize=7, frameon=False)
    figure.savefig(output, dpi=110)


def _draw_row(axis: pyplot.Axes, row: dict) -> None:
    in_blender = row.get("in_blender", False)
    rates, stages = 1 / np.array(row["seconds"]), row["stages"]
    color, label = ("#2a6f97", "in Blender, its evaluation included") if in_blender else ("#c05a1c", "core alone")
    axis.semilogy(np.arange(1, len(rates) + 1), rates, lw=1.2, color=color, label=label)
    for change in (k for k in range(1, len(rates)) if stages[k] != stages[k - 1]):
        axis.axvline(change + 0.5, color=color, alpha=0.5, lw=0.8, ls="--")


def main() -> None:
    """Draw the contents of the files."""
    parser = argparse.ArgumentParser(description="Draw frames a second over sessions.")
    parser.add_argument("profiles", type=Path, nargs="+", help="written by stiv bench profile --json")
    parser.add_argument("--scenes", nargs="+", default=["plant", "dressing"], help="default: those of Figure 12")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "gallery" / "profile.png")
    arguments = parser.parse_args()
    rows = [row for path in arguments.profiles for row in json.loads(path.read_text(encoding="utf-8"))["rows"]]
    draw([row for row in rows if row["scene"] in arguments.scenes and row["threads"] == 1], arguments.output)


if __name__ == "__main__":
    main()
