# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder addon/ under the name that the tests import, unless the wheel has installed it."""

import importlib.util
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "addon"

if importlib.util.find_spec("stiv_addon") is None:
    spec = importlib.util.spec_from_file_location(
        "stiv_addon", FOLDER / "__init__.py", submodule_search_locations=[str(FOLDER)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["stiv_addon"] = module
    spec.loader.exec_module(module)
