# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that several subcommands share."""

from __future__ import annotations

import argparse

from stiv.choices import GUARDS
from stiv.command_line.installed_blender import OPTION
from stiv.frame_ranges import parse_frames


def add_guard_option(parser: argparse.ArgumentParser) -> None:
    """Adds `--guard`; its default, "", stands for the setting in the file."""
    parser.add_argument(
        "--guard", choices=GUARDS, default="",
        help="the evaluations of a .blend that stay free of intersections (default: the setting in the file)",
    )  # fmt: skip


def add_blender_option(parser: argparse.ArgumentParser) -> None:
    """Adds `--blender PATH`."""
    parser.add_argument(OPTION, metavar="PATH", help="use this installed Blender (default: the Python module bpy)")


def frame_range(text: str) -> tuple[int, int, int] | str:
    """Type of an argument with a range of frames."""
    try:
        return parse_frames(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
