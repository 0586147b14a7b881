# SPDX-License-Identifier: GPL-3.0-or-later
"""Script for an installed Blender (`--python`): runs the command line with the arguments after `--`.

Uses the STIV of this file, and Blender's NumPy.
"""

import os
import sys
from pathlib import Path

PACKAGES = Path(__file__).absolute().parents[2]  # the folder with the package


def main() -> int:
    """Runs the command and returns its exit code."""
    if str(PACKAGES) not in sys.path:
        sys.path.append(str(PACKAGES))
    try:
        from stiv.command_line import program
        from stiv.command_line.installed_blender import BEGINS
    except ImportError as error:
        version = ".".join(map(str, sys.version_info[:2]))
        print(
            f"stiv: this Blender runs Python {version}, and cannot load STIV from {PACKAGES}: {error}; "
            f"install and run STIV for Python {version}",
            file=sys.stderr,
        )
        print("stiv begins")
        return 2
    print(BEGINS, flush=True)
    return program.run(sys.argv[sys.argv.index("--") + 1 :])


if __name__ == "__main__":
    CODE = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(CODE)
