# SPDX-License-Identifier: GPL-3.0-or-later
"""Install a zip, enable it, use it, and report where its parts come from and what it touched.

test_extension runs this in a subprocess.
"""

import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

import bpy

NAME = "bl_ext.user_default.stiv"
EVENTS = ("socket.", "subprocess.", "os.system", "os.exec", "os.fork", "os.posix_spawn", "_thread.start_new_thread")
CHANGES = ("os.mkdir", "os.remove", "os.rename", "os.rmdir", "os.link", "os.symlink", "os.truncate", "shutil.")
TEMPORARY = Path(tempfile.gettempdir())
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND

violations: list[str] = []
watching = False


def watch(event: str, arguments: tuple[Any, ...]) -> None:
    """Note threads, processes, connections, and files opened for writing outside the folder of temporary files."""
    if not watching:
        return
    if event.startswith((*EVENTS, *CHANGES)):
        violations.append(f"{event} {arguments}")
    elif event == "open" and isinstance(arguments[0], str) and (arguments[2] or 0) & WRITING:
        path = Path(arguments[0])
        violations.extend([f"open {arguments}"] if TEMPORARY not in (path, *path.parents) else [])


def install(archive: str, resources: Path) -> None:
    """Install and enable the extension, then check its operators and the origin of its native module."""
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    assert NAME in bpy.context.preferences.addons, "the add-on was not enabled"
    for name in ("move", "rotate", "scale"):
        assert hasattr(bpy.types, f"STIV_OT_{name}"), f"operator stiv.{name} is not registered"

    import stiv._native

    assert resources in Path(stiv._native.__file__).parents, f"core comes from {stiv._native.__file__}"


def registered() -> set[str]:
    """Names of all classes, of the add-on's settings, and of the packages of handlers."""
    owners = (bpy.types.Scene, bpy.types.Object, bpy.types.WindowManager)
    settings = {f"{owner.__name__}.{name}" for owner in owners for name in dir(owner) if name.startswith("stiv")}
    lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)]
    handlers = {handler.__module__ for each in lists if isinstance(each, list) for handler in each}
    return set(dir(bpy.types)) | settings | handlers


def use() -> None:
    """Move a cube to a wall, check, copy a report, and open an example."""
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    bpy.ops.mesh.primitive_plane_add(size=6, location=(3, 0, 0), rotation=(0, 1.5708, 0))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0))
    assert bpy.ops.stiv.move(value=(5, 0, 0)) == {"FINISHED"}
    assert 2 < bpy.context.object.location.x < 2.6, "the cube did not stop at the wall"
    assert bpy.ops.stiv.check() == {"FINISHED"}
    assert bpy.ops.stiv.copy_report() == {"FINISHED"}
    assert bpy.ops.stiv.open_example(example="pot_plant") == {"FINISHED"}


def check_saved(path: Path) -> None:
    """Save the scene below the user's folder, and check the file with the command."""
    from stiv.command_line import program

    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    assert program.run(["check", str(path)]) == 0, f"{path} is not free"


def main(archive: str, resources: Path) -> None:
    """Install unwatched, because Blender writes then; use watched."""
    global watching
    install(archive, resources)
    paths = list(sys.path)
    sys.dont_write_bytecode = True  # Python's own files beside sources
    sys.addaudithook(watch)
    watching = True
    addon = sys.modules[NAME]
    addon.unregister()
    before = registered()
    addon.register()
    added = registered() - before
    assert added, "nothing was registered"
    assert not [name for name in added if "stiv" not in name.lower()], added
    use()
    addon.unregister()
    watching = False
    assert registered() <= before, registered() - before
    assert not violations, "\n".join(violations)
    assert sys.path == paths, "sys.path has changed"
    check_saved(resources / "scène ü 花.blend")


if __name__ == "__main__":
    code = 0
    try:
        main(sys.argv[1], Path(sys.argv[2]))
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
