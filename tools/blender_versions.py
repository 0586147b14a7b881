# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the Blender versions that exist as modules for the running Python, on one line; with --demo, the demo's.

With --python VERSION: the version of Python in that Blender.
"""

import sys
import tomllib
from pathlib import Path

TABLE = Path(__file__).with_name("blender_versions.toml")


def main(arguments: list[str]) -> int:
    """Print the versions; the exit code is 1 if no Blender module exists for this Python."""
    table = tomllib.loads(TABLE.read_text())
    if arguments[:1] == ["--python"]:
        print(*[python for python, row in table.items() if arguments[1] in row["blender"]])
        return 0
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    entry = table.get(python)
    if entry is None:
        problem = f"no Blender module exists for Python {python}; set STIV_PYTHON to a Python 3.11 or 3.13"
        print(problem, file=sys.stderr)
        return 1
    print(entry["demo"] if "--demo" in arguments else " ".join(entry["blender"]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
