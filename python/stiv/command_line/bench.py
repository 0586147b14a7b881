# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv bench`: measures editing sessions. The measurements are in a source checkout, not in the wheel."""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from stiv import InputError
from stiv.exit_codes import ExitCode

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

MODULE = "benchmarks.sessions.command"


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand. It passes all arguments on, so no character marks an option."""
    parser = subcommands.add_parser(
        "bench", help="measure editing sessions as the paper does", add_help=False, prefix_chars="\0"
    )
    parser.add_argument("arguments", nargs="*")
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    code: ExitCode = _measurements().run(arguments.arguments)
    return code


def _measurements() -> ModuleType:
    """The module of the measurements. Raises InputError outside a source checkout."""
    root = Path.cwd()
    if root.joinpath(*MODULE.split(".")).with_suffix(".py").is_file() and str(root) not in sys.path:
        sys.path.append(str(root))
    try:
        return importlib.import_module(MODULE)
    except ModuleNotFoundError as error:
        if not f"{MODULE}.".startswith(f"{error.name}."):
            raise
    raise InputError(
        "bench: the measurements are in the folder benchmarks/ of STIV's source code, not in the wheel; "
        "run `stiv bench` in a source checkout"
    )
