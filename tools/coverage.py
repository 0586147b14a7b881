# SPDX-License-Identifier: GPL-3.0-or-later
"""Line coverage of the core by folder, from the runs in a build folder; the exit code is 1 if a folder is
below PERCENT.

Usage: coverage.py BUILD_FOLDER --at-least PERCENT FOLDER...   with folders of native/src, such as detection.
"""

import argparse
import json
import subprocess
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def lines_by_file(build: Path) -> dict[str, tuple[int, int]]:
    """All lines and the executed lines of each file of the core."""
    command = ["gcovr", "--root", ".", "--filter", "native/src/", "--filter", "native/include/", "--json-summary", "-"]
    text = subprocess.run([*command, build], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return {f["filename"]: (f["line_total"], f["line_covered"]) for f in json.loads(text)["files"]}


def folder_of(file: str) -> str:
    """native/src/detection/detector.cpp and native/include/stiv/detection/detector.hpp belong to detection."""
    parts = Path(file).parts
    inner = parts[2:-1] if parts[1] == "src" else parts[3:-1]
    return inner[0] if inner else "core"


def is_below(total: int, covered: int, percent: float) -> bool:
    """Tell whether coverage is below the limit; a folder without lines does not pass either."""
    return total == 0 or 100 * covered < percent * total


def main() -> int:
    """Print the folders, and the files below the limit in the requested ones."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path)
    parser.add_argument("--at-least", type=float, required=True)
    parser.add_argument("folders", nargs="+")
    arguments = parser.parse_args()
    folders: dict[str, list[int]] = defaultdict(lambda: [0, 0])
    files = lines_by_file(arguments.build)
    for file, (total, covered) in files.items():
        folders[folder_of(file)][0] += total
        folders[folder_of(file)][1] += covered
    for folder, (total, covered) in sorted(folders.items()):
        print(f"{folder:14} {covered:5} of {total:5} lines  {100 * covered / total:6.2f} %")
    for file, (total, covered) in sorted(files.items()):
        if folder_of(file) in arguments.folders and is_below(total, covered, arguments.at_least):
            print(f"    {file}: {covered} of {total}")
    low = [
        f for f in arguments.folders if 100 * folders[f][1] < arguments.at_least * folders[f][0] or not folders[f][0]
    ]
    if low:
        print(f"below {arguments.at_least:g} %: {', '.join(low)}")
    return int(bool(low))


if __name__ == "__main__":
    raise SystemExit(main())
