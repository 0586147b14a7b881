# SPDX-License-Identifier: GPL-3.0-or-later
"""Validate the extension's zip with Blender and install it like a user.

Usage: VENV/bin/python install_extension.py ZIP            into the Blender module of the current environment
       python install_extension.py ZIP --blender PROGRAM   into a Blender program, for its user

Into a module: Blender unpacks the zip and the matching wheel below VENV/extension, and the environment finds
the packages there: `stiv` from the unpacked wheel, and `stiv_addon`, the installed add-on.
"""

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

REPOSITORY = "user_default"
IDENTIFIER = "stiv"


def into_program(archive: Path, program: str) -> None:
    """Let a Blender program validate and install."""
    extension = [program, "--command", "extension"]
    subprocess.run([*extension, "validate", archive], check=True)
    subprocess.run([*extension, "install-file", "-r", REPOSITORY, "--enable", archive], check=True)


def into_module(archive: Path, environment: Path) -> None:
    """Let this environment's Blender module validate and install, in a subprocess."""
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "uninstall", "--yes", IDENTIFIER]
    subprocess.run(pip, check=True, stderr=subprocess.DEVNULL)  # an older installed wheel would be found first
    resources = environment / "extension"
    shutil.rmtree(resources, ignore_errors=True)
    resources.mkdir()
    process = os.environ | {"BLENDER_USER_RESOURCES": str(resources), "HOME": str(resources)}
    subprocess.run([sys.executable, __file__, archive, "--here"], env=process, check=True)
    (resources / "package").mkdir()
    installed, package = resources / "extensions" / REPOSITORY / IDENTIFIER, resources / "package/stiv_addon"
    if sys.platform == "win32":  # where a link needs privileges
        shutil.copytree(installed, package, copy_function=shutil.copyfile)  # copy2 needs a newer Wine than 8
    else:
        package.symlink_to(installed)
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    wheels = resources / "extensions/.local/lib" / version / "site-packages"
    folders = Path(sysconfig.get_path("purelib"))
    (folders / "stiv_extension.pth").write_text(f"{resources / 'package'}\n{wheels}\n")


def validation(archive: Path) -> list[str | Path]:
    """Validation of an archive, including its tags, by this environment's Blender module, as in a Blender program."""
    import bpy

    scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    tags = scripts / "modules/_bpy_internal/extensions/tags.py"
    validator = scripts / "addons_core/bl_pkg/cli/blender_ext.py"
    return [sys.executable, validator, "validate", "--valid-tags", tags, archive]


def here(archive: Path) -> None:
    """Validate, install and enable the extension, and check that the native module loads. Ends the process."""
    import bpy

    subprocess.run(validation(archive), check=True, stdout=subprocess.DEVNULL)
    bpy.ops.extensions.package_install_files(filepath=str(archive), repo=REPOSITORY, enable_on_install=True)
    name = f"bl_ext.{REPOSITORY}.{IDENTIFIER}"
    enabled = name in bpy.context.preferences.addons
    problem = sys.modules[f"{name}.native_module"].problem() if enabled else "it was not enabled"
    if problem:
        print(f"{archive}, installed into Blender {bpy.app.version_string}: {problem}", file=sys.stderr)
    sys.stdout.flush()
    os._exit(1 if problem else 0)  # 4.2 crashes and 4.5 hangs when Python exits with registered classes


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("archive", type=Path)
    parser.add_argument("--blender", help="a Blender program to install into, instead of the module")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.here:
        here(chosen.archive.resolve())
    elif chosen.blender:
        into_program(chosen.archive.resolve(), chosen.blender)
    else:
        into_module(chosen.archive.resolve(), Path(sys.prefix))


if __name__ == "__main__":
    main()
