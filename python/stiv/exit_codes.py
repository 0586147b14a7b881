# SPDX-License-Identifier: GPL-3.0-or-later
"""Exit codes of the command `stiv`."""

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes of every subcommand."""

    DONE = 0
    USAGE = 1
    BAD_INPUT = 2
    INTERNAL_ERROR = 3
    NOT_FREE = 4
    CANCELLED = 5
