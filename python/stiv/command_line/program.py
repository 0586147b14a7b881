# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `stiv`: parses arguments, runs the subcommand and returns an exit code."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from collections.abc import Sequence
from typing import NoReturn

from stiv import InputError
from stiv.batch.worker import serve
from stiv.command_line import batch, bench, check, demo, repair, replay, resolve, self_test
from stiv.command_line.installed_blender import run_inside, without_option
from stiv.exit_codes import ExitCode

_SUBCOMMANDS = (demo, check, replay, repair, resolve, batch, bench, self_test)


class Parser(argparse.ArgumentParser):
    """Ends wrong usage with exit code 1, instead of 2 as in argparse."""

    def error(self, message: str) -> NoReturn:
        """Prints usage and message, and exits."""
        self.print_usage(sys.stderr)
        self.exit(ExitCode.USAGE, f"{self.prog}: {message}\n")


def parser() -> argparse.ArgumentParser:
    """The parser with all subcommands."""
    top = Parser(prog="stiv", description="Interference-aware geometric modeling.")
    subcommands = top.add_subparsers(title="subcommands", metavar="COMMAND", required=True)
    for subcommand in _SUBCOMMANDS:
        subcommand.add_to(subcommands)
    worker = subcommands.add_parser("worker")  # of `stiv batch`; the help does not list it
    worker.set_defaults(run=lambda arguments: serve(run))
    return top


def run(arguments: Sequence[str] | None = None) -> int:
    """Runs the command with these arguments (default: those of the process) and returns its exit code."""
    try:
        chosen = parser().parse_args(arguments)
        blender = getattr(chosen, "blender", None)
        if blender is not None:
            return run_inside(blender, without_option(sys.argv[1:] if arguments is None else arguments))
        return int(chosen.run(chosen))
    except SystemExit as end:  # --help or wrong usage
        return int(end.code or 0)
    except InputError as error:
        print(f"stiv: {error}", file=sys.stderr)
        return ExitCode.BAD_INPUT
    except KeyboardInterrupt:
        print("stiv: cancelled", file=sys.stderr)
        return ExitCode.CANCELLED
    except Exception:
        traceback.print_exc()
        print("stiv: internal error; please report it with the lines above", file=sys.stderr)
        return ExitCode.INTERNAL_ERROR


def main() -> NoReturn:
    """Runs the command and exits."""
    code = run()
    sys.stdout.flush()
    sys.stderr.flush()
    if "bpy" in sys.modules:
        os._exit(code)  # Blender 4.2 and 4.5 as modules may crash or hang when the interpreter exits
    sys.exit(code)
