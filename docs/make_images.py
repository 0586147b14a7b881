# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the pictures of this folder: run the demo and copy its two renders.

python docs/make_images.py
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
DEMO = ROOT / "build" / "demo"


def main() -> int:
    """Run the demo and copy before.png and after.png; the exit code is the demo's."""
    command = [sys.executable, "-m", "stiv.command_line", "demo", "--output", str(DEMO)]
    code = subprocess.run(command, check=False).returncode
    if code == 0:
        IMAGES.mkdir(parents=True, exist_ok=True)
        for name in ("before", "after"):
            shutil.copyfile(DEMO / f"{name}.png", IMAGES / f"plant_{name}.png")
    return code


if __name__ == "__main__":
    sys.exit(main())
