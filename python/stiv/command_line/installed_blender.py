# SPDX-License-Identifier: GPL-3.0-or-later
"""`--blender PATH`: runs the command in an installed Blender instead of Blender as a Python module.

Blender starts without user settings. Scripts in .blend files are disabled.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from stiv import InputError

OPTION = "--blender"
BEGINS = "stiv begins"  # the line before the output of the command
_SCRIPT = Path(__file__).with_name("inside_blender.py")


def blender_command(blender: str, arguments: Sequence[str]) -> list[str]:
    """The command that runs `stiv` in an installed Blender. Raises InputError if there is none."""
    found = shutil.which(blender)
    if found is None:
        raise InputError(f"{OPTION}: {blender} is not an executable program")
    options = ["-b", "--factory-startup", "--disable-autoexec", "--python-exit-code", "3", "--python"]
    return [found, *options, str(_SCRIPT), "--", *arguments]


def run_inside(blender: str, arguments: Sequence[str]) -> int:
    """Runs the command with these arguments in Blender, and returns its exit code."""
    command = blender_command(blender, arguments)
    try:
        started = subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", errors="replace")
    except OSError as error:  # on Windows, any file counts as executable before
        raise InputError(f"{OPTION}: {blender} is not an executable program") from error
    with started as process:
        assert process.stdout is not None
        began = False
        for line in process.stdout:
            if began:
                sys.stdout.write(line)
            began = began or line.rstrip() == BEGINS
    if not began:
        raise InputError(f"{OPTION}: {blender} did not run STIV's script; it ended with exit code {process.returncode}")
    return process.returncode


def without_option(arguments: Sequence[str]) -> list[str]:
    """The arguments without the option and its value."""
    left: list[str] = []
    skip = False
    for argument in arguments:
        if skip or argument.startswith(OPTION + "="):
            skip = False
        elif argument == OPTION:
            skip = True
        else:
            left.append(argument)
    return left
