# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the source archive with pip into a new environment, which compiles it, and run the self-test there.

Usage: source_archive.py [--folder F]   a new folder for archive and environment; default: a temporary one
"""

import argparse
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TEST = "import stiv; result = stiv.self_test(); print(stiv.__file__, result); raise SystemExit(not result.passed)"


def main(folder: Path) -> None:
    """Archive, install, test."""
    subprocess.run([ROOT / "tools/source_archive.sh", sys.executable, folder], cwd=ROOT, check=True)
    (archive,) = folder.glob("stiv-*.tar.gz")
    venv.create(folder / "venv", with_pip=True)
    python = folder / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", archive], check=True)
    subprocess.run([python, "-c", TEST], cwd=folder, check=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path)
    chosen = parser.parse_args().folder
    if chosen:
        main(chosen.resolve())
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary))
