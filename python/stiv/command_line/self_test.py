# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv self-test`: does this machine compute the committed results?"""

from __future__ import annotations

import argparse
import platform
import sys
from typing import TYPE_CHECKING

from stiv.exit_codes import ExitCode
from stiv.self_test import EXPECTED_EDITS, EXPECTED_INTERSECTIONS, self_test

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

_DESCRIPTION = (
    "Run 40 edits and 100,000 intersection tests, and compare the bits of the results with the committed ones."
)
_EPILOG = "exit codes: 0 the same bits, 3 other bits: please report the output, 1 wrong usage"


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "self-test", help="compare the results of this machine with the committed ones", description=_DESCRIPTION,
        epilog=_EPILOG,
    )  # fmt: skip
    parser.set_defaults(run=_run)


def _run(_: argparse.Namespace) -> ExitCode:
    result = self_test()
    print(f"{platform.platform()}, Python {platform.python_version()}, {result.vectors}, {sys.byteorder} endian")
    print(_line("40 edits", result.edits, EXPECTED_EDITS))
    print(_line("100,000 intersection tests", result.intersections, EXPECTED_INTERSECTIONS))
    return ExitCode.DONE if result.passed else ExitCode.INTERNAL_ERROR


def _line(name: str, here: str, expected: str) -> str:
    return f"{name}: {here} " + ("(as expected)" if here == expected else f"(WRONG: expected {expected})")
