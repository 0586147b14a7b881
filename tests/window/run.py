# SPDX-License-Identifier: GPL-3.0-or-later
"""Drive the extension in a real window of Blender, in a Debian folder under a display in memory.

Usage: run.py [--folder DIR] [--opensubdiv DIR] [--pictures DIR] [--report F] [--sequences N] [SCENARIO...]

Sets everything up itself where it can (root, debootstrap, Debian's archive), otherwise says why it cannot and skips
(exit code 0). Exit code 1 when a scenario fails.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import debian_folder

ROOT = Path(__file__).resolve().parents[2]
INSIDE = Path("/opt/stiv")  # in the folder
SCREEN = (1280, 800)
TIME_LIMIT = 900.0  # seconds for all scenarios
SEQUENCES = 200  # of random events


def main() -> int:
    """Set up, build, drive, report."""
    chosen = arguments()
    folder = chosen.folder.resolve()
    why_not = debian_folder.obstacle() or set_up(folder)
    if why_not:
        print(f"window tests skipped: {why_not}")
        write_report(chosen.report, {"window": None}, why_not)
        return 0
    with debian_folder.system_mounts(folder):
        copy_sources(folder, chosen.opensubdiv.resolve())
        build(folder)
        drive(folder, chosen.scenarios, chosen.sequences)
    keep_pictures(folder, chosen.pictures)
    failures = read_failures(folder)
    write_report(chosen.report, failures)
    return report(failures)


def set_up(folder: Path) -> str:
    """Why the folder could not be filled (no network, no right to mount), empty if it is."""
    try:
        debian_folder.prepare(folder)
    except (subprocess.SubprocessError, OSError) as error:
        return f"the Debian folder could not be set up: {error}"
    return ""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=ROOT / "build/window/debian", help="the Debian folder")
    parser.add_argument("--opensubdiv", type=Path, default=ROOT / "build/opensubdiv", help="OpenSubdiv's source")
    parser.add_argument("--pictures", type=Path, default=ROOT / "build/window/pictures", help="where pictures go")
    parser.add_argument("--report", type=Path, default=ROOT / "build/test-reports/window.xml", help="JUnit file")
    parser.add_argument("--sequences", type=int, default=SEQUENCES, help="how many sequences of random events")
    parser.add_argument("scenarios", nargs="*", help="names; all when none is given")
    return parser.parse_args()


def copy_sources(folder: Path, opensubdiv: Path) -> None:
    """The files of the source tree that differ, so that the build inside is quick the second time."""
    home = folder / INSIDE.relative_to("/")
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, check=True, capture_output=True,
    )  # fmt: skip
    for name in filter(None, listed.stdout.decode().split("\0")):
        copy_changed(ROOT / name, home / "source" / name)
    for path in opensubdiv.rglob("*"):
        copy_changed(path, home / "opensubdiv" / path.relative_to(opensubdiv))


def copy_changed(source: Path, target: Path) -> None:
    """Copy a file unless the target is the same already."""
    if not source.is_file() or (target.is_file() and target.read_bytes() == source.read_bytes()):
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def build(folder: Path) -> None:
    """The native module for the Python inside, beside the package."""
    source, binary = INSIDE / "source", INSIDE / "build"
    options = ["-DSTIV_BUILD_PYTHON=ON", "-DSTIV_BUILD_TESTS=OFF", f"-DSTIV_OPENSUBDIV_SOURCE={INSIDE}/opensubdiv"]
    configure = ["cmake", "-S", str(source), "-B", str(binary), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *options]
    print("native module for the window's Python", flush=True)
    debian_folder.run(folder, configure, quiet=True)
    debian_folder.run(folder, ["cmake", "--build", str(binary), "--target", "_native"], quiet=True)
    for module in (folder / binary.relative_to("/")).glob("native/bindings/_native*.so"):
        shutil.copyfile(module, folder / source.relative_to("/") / "python/stiv" / module.name)


def drive(folder: Path, scenarios: list[str], sequences: int) -> None:
    """Run Blender with the driver; it leaves results and pictures in the folder."""
    results = folder / INSIDE.relative_to("/") / "results"
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)
    width, height = map(str, SCREEN)
    blender = [
        "blender", "--factory-startup", "--enable-event-simulate", "--window-geometry", "0", "0", width, height,
        "--python", f"{INSIDE}/source/tests/window/driver.py", "--", f"{INSIDE}/results", *scenarios,
    ]  # fmt: skip
    screen = f"-screen 0 {width}x{height}x24"
    command = [
        "env",
        f"STIV_WINDOW_SEQUENCES={sequences}",
        "LIBGL_ALWAYS_SOFTWARE=1",
        "xvfb-run",
        "-a",
        "-s",
        screen,
        *blender,
    ]
    try:
        debian_folder.run(folder, command, timeout=TIME_LIMIT)
    except subprocess.SubprocessError as error:
        print(f"Blender did not end well: {error}")


def keep_pictures(folder: Path, pictures: Path) -> None:
    """Copy the screenshots out."""
    pictures.mkdir(parents=True, exist_ok=True)
    for picture in (folder / INSIDE.relative_to("/") / "results").glob("*.png"):
        shutil.copyfile(picture, pictures / picture.name)


def read_failures(folder: Path) -> dict[str, str | None]:
    """The failure of each scenario, empty where it passed; "driver" for an end that was not reached."""
    path = folder / INSIDE.relative_to("/") / "results/results.json"
    if not path.is_file():
        return {"driver": "no results: the driver did not start"}
    results = json.loads(path.read_text())
    failures: dict[str, str | None] = dict(results["scenarios"])
    if not results["complete"]:
        failures["driver"] = f"Blender ended, or was ended, during {results.get('running') or 'the start'}"
    return failures


def report(failures: dict[str, str | None]) -> int:
    """Print a line a scenario; 1 if one failed."""
    for name, failure in failures.items():
        print(f"{'FAILED' if failure else 'passed'}  {name}")
        if failure:
            print("        " + failure.replace("\n", "\n        "))
    return int(any(failures.values()))


def write_report(path: Path, failures: dict[str, str | None], why_skipped: str = "") -> None:
    """The same as a JUnit file."""
    suite = ElementTree.Element("testsuite", name="window")
    for name, failure in failures.items():
        case = ElementTree.SubElement(suite, "testcase", classname="window", name=name)
        if why_skipped:
            ElementTree.SubElement(case, "skipped", message=why_skipped)
        elif failure:
            ElementTree.SubElement(case, "failure", message=failure.strip().splitlines()[-1]).text = failure
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path)


if __name__ == "__main__":
    raise SystemExit(main())
