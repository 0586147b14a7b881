# SPDX-License-Identifier: GPL-3.0-or-later
"""Every module of the add-on can be imported first: a test, a script or the guard may do so."""

import subprocess
import sys

import pytest

bpy = pytest.importorskip("bpy")

import stiv_addon  # noqa: E402

EACH_FIRST = """
import importlib, importlib.util, os, pkgutil, sys, traceback
import bpy

def forget():
    for name in [name for name in sys.modules if name.partition(".")[0] == "stiv_addon"]:
        del sys.modules[name]
    spec = importlib.util.spec_from_file_location(
        "stiv_addon", os.path.join(sys.argv[1], "__init__.py"), submodule_search_locations=[sys.argv[1]]
    )
    sys.modules["stiv_addon"] = package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)

failed = 0
for module in pkgutil.walk_packages([sys.argv[1]], "stiv_addon.", onerror=lambda name: None):
    forget()
    try:
        importlib.import_module(module.name)
    except ImportError:
        failed = 1
        traceback.print_exc()
sys.stderr.flush()
os._exit(failed)  # Blender may crash when Python exits
"""


@pytest.mark.shared
def test_every_module_can_be_imported_first() -> None:
    folder = next(iter(stiv_addon.__path__))
    done = subprocess.run([sys.executable, "-c", EACH_FIRST, folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
