# SPDX-License-Identifier: GPL-3.0-or-later
"""The option --guard of commands that change a .blend."""

import argparse

CHOICES = ("auto", "viewport", "render", "both")


def add_guard_option(parser: argparse.ArgumentParser) -> None:
    """Let the user say what stays free of intersections; without the option, "": as the scene says."""
    parser.add_argument(
        "--guard", choices=CHOICES, default="",
        help="what stays free of intersections in a .blend (default: the setting in the file)",
    )  # fmt: skip
