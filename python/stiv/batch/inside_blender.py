# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by an installed Blender (`--python`): a worker, with STIV from where this file is."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2]))

from stiv.batch.worker import main

main()
