# SPDX-License-Identifier: GPL-3.0-or-later
"""Install a zip, enable it, and report the origin of its parts; test_extension runs this in a subprocess."""

import os
import sys
import traceback
from pathlib import Path

import bpy


def install(archive: str, resources: Path) -> None:
    """Install and enable the extension, then check its operators and the origin of its native module."""
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    assert "bl_ext.user_default.stiv" in bpy.context.preferences.addons, "the add-on was not enabled"
    for name in ("move", "rotate", "scale"):
        assert hasattr(bpy.types, f"STIV_OT_{name}"), f"operator stiv.{name} is not registered"

    import stiv._native

    assert resources in Path(stiv._native.__file__).parents, f"core comes from {stiv._native.__file__}"


if __name__ == "__main__":
    code = 0
    try:
        install(sys.argv[1], Path(sys.argv[2]))
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
