# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `stiv`: one subcommand a file."""

from stiv.command_line.program import main

__all__ = ["main"]
