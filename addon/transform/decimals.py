# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers as text for the header, as Blender writes them there."""

from __future__ import annotations

DECIMALS = 4


def decimal_text(value: float, decimals: int = DECIMALS) -> str:
    """A number with at most so many digits after the point, without trailing zeros; rounding noise becomes "0"."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text
