# SPDX-License-Identifier: GPL-3.0-or-later
"""Drive the extension, installed from its zip, in a real window of Blender: in a Debian folder, on a display in memory.

Usage: build/venv/bin/python tests/window/run.py [--release trixie|sid] [--folder DIR] [--zip ZIP] [--pictures DIR]
                                                 [--report F] [--sequences N] [--first N] [--limit SECONDS]
                                                 [SCENARIO...]

Sets everything up itself where it can (root, debootstrap, Debian's archive), otherwise says why it cannot and skips
(exit code 0); a package that the archive does not have is a failure. Without --zip the extension is built for the
Python of that release, out of build/wheel and build/native, which `make` fills. Events are simulated by Blender itself,
except for the scenario real_events, which has a Blender of its own. Exit code 1 when a scenario fails.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import debian_folder

ROOT = Path(__file__).resolve().parents[2]
INSIDE = Path("/opt/stiv")  # in the folder
USED = ("tests/window", "blend_fixtures")  # what the driver reads of the source tree
BLENDER = ("env", f"BLENDER_USER_RESOURCES={INSIDE}/user", "blender")
SCREEN = (1280, 800)
TIME_LIMIT = 3600.0  # seconds for all scenarios; where Blender hangs, driver.py ends it much sooner
SEQUENCES = 200  # of random events
REPEATED = 2  # the most failed scenarios that are played again; with more, the machine is not the cause
REAL = "real_events"  # the scenario for which Blender must not simulate events: then it hears no others


def main() -> int:
    """Set up, install, drive, report."""
    chosen = arguments()
    folder = (chosen.folder or ROOT / "build/window" / chosen.release).resolve()
    try:
        why_not = debian_folder.obstacle() or set_up(folder, chosen.release)
    except debian_folder.UnknownPackagesError as error:
        write_report(chosen.report, {"set-up": str(error)})
        return report({"set-up": str(error)})
    if why_not:
        print(f"window tests skipped: {why_not}")
        write_report(chosen.report, {"window": None}, why_not)
        return 0
    archive = chosen.zip or built_extension(chosen.release)
    with debian_folder.system_mounts(folder):
        copy_sources(folder)
        install(folder, archive)
        failures = play(folder, chosen, chosen.scenarios)
        failures |= play_again(folder, chosen, failures)
    write_report(chosen.report, failures)
    return report(failures)


def play(folder: Path, chosen: argparse.Namespace, names: list[str]) -> dict[str, str | None]:
    """Play these scenarios, all without names; returns the failure of each, see `read_failures`."""
    failures: dict[str, str | None] = {}
    for simulated, scenarios in sessions(names):
        drive(folder, chosen, simulated, scenarios)
        keep_pictures(folder, chosen.pictures)
        failures |= read_failures(folder)
    return failures


def play_again(folder: Path, chosen: argparse.Namespace, failures: dict[str, str | None]) -> dict[str, str | None]:
    """Play a few failed scenarios once more: on a busy machine, an event may come too late."""
    failed = [name for name, failure in failures.items() if failure]
    if not failed or len(failed) > REPEATED or "driver" in failed:
        return {}
    second = play(folder, chosen, failed)
    for name in failed:
        if not second.get(name):
            print(f"{name}: passed at the second attempt; the first one failed:\n{failures[name]}")
    return second


def set_up(folder: Path, release: str) -> str:
    """Why the folder could not be filled (no network, no right to mount); empty if it was."""
    try:
        debian_folder.prepare(folder, release)
    except (subprocess.SubprocessError, OSError) as error:
        return f"the Debian folder could not be set up: {error}"
    return ""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--release", default="trixie", help="of Debian: trixie (Blender 4.3) or sid (5.2)")
    parser.add_argument("--folder", type=Path, help="the Debian folder; build/window/RELEASE when not given")
    parser.add_argument("--zip", type=Path, help="the extension; built when not given")
    parser.add_argument("--pictures", type=Path, default=ROOT / "build/window/pictures", help="where pictures go")
    parser.add_argument("--report", type=Path, default=ROOT / "build/test-reports/window.xml", help="JUnit file")
    parser.add_argument("--sequences", type=int, default=SEQUENCES, help="how many sequences of random events")
    parser.add_argument("--first", type=int, default=0, help="the number of the first of them")
    parser.add_argument("--limit", type=float, default=TIME_LIMIT, help="seconds for all scenarios")
    parser.add_argument("scenarios", nargs="*", help="names; all when none is given")
    return parser.parse_args()


def built_extension(release: str) -> Path:
    """The extension's zip for the Python of a release, from the modules that `make` compiled."""
    command = [ROOT / "tools/window_extension.sh", sys.executable, release, f"build/window/extension-{release}"]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return ROOT / done.stdout.split()[-1]


def copy_sources(folder: Path) -> None:
    """Scenarios and scenes; nothing of the extension, which comes from its zip."""
    source = folder / INSIDE.relative_to("/") / "source"
    shutil.rmtree(source, ignore_errors=True)
    for name in USED:
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))


def install(folder: Path, archive: Path) -> None:
    """Let Blender validate the zip and install it for a new user."""
    home = folder / INSIDE.relative_to("/")
    shutil.rmtree(home / "user", ignore_errors=True)
    (home / "user").mkdir(parents=True)
    shutil.copyfile(archive, home / archive.name)
    print(f"installing {archive.name}", flush=True)
    extension = [*BLENDER, "--command", "extension"]
    inside = str(INSIDE / archive.name)
    debian_folder.run(folder, [*extension, "validate", inside], quiet=True)
    debian_folder.run(folder, [*extension, "install-file", "-r", "user_default", "--enable", inside], quiet=True)


def sessions(names: list[str]) -> list[tuple[bool, list[str]]]:
    """The runs of Blender, with simulated events or those of the display, and their scenarios."""
    simulated = [name for name in names if name != REAL]
    both = [(True, simulated)] if simulated or not names else []
    return both + ([(False, [REAL])] if REAL in names or not names else [])


def drive(folder: Path, chosen: argparse.Namespace, simulated: bool, scenarios: list[str]) -> None:
    """Run Blender with the driver; it leaves results and pictures in the folder."""
    results = folder / INSIDE.relative_to("/") / "results"
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)
    width, height = map(str, SCREEN)
    command = [
        "env", "LIBGL_ALWAYS_SOFTWARE=1", f"STIV_WINDOW_SEQUENCES={chosen.sequences}",
        f"STIV_WINDOW_FIRST_SEQUENCE={chosen.first}",
        *(f"{name}={value}" for name, value in os.environ.items() if name.startswith("STIV_WINDOW_")),
        "xvfb-run", "-a", "-s", f"-screen 0 {width}x{height}x24",
        *BLENDER, *(["--enable-event-simulate"] if simulated else []), "--window-geometry", "0", "0", width, height,
        "--python", f"{INSIDE}/source/tests/window/driver.py", "--", f"{INSIDE}/results", *scenarios,
    ]  # fmt: skip
    try:
        debian_folder.run(folder, command, timeout=chosen.limit)
    except subprocess.SubprocessError as error:
        print(f"Blender did not end well: {error}")


def keep_pictures(folder: Path, pictures: Path) -> None:
    """Copy the screenshots out."""
    pictures.mkdir(parents=True, exist_ok=True)
    for picture in (folder / INSIDE.relative_to("/") / "results").glob("*.png"):
        shutil.copyfile(picture, pictures / picture.name)


def read_failures(folder: Path) -> dict[str, str | None]:
    """The failure of each scenario, empty if it passed; "driver" if Blender ended early."""
    path = folder / INSIDE.relative_to("/") / "results/results.json"
    if not path.is_file():
        return {"driver": "no results: the driver did not start"}
    results = json.loads(path.read_text())
    failures: dict[str, str | None] = dict(results["scenarios"])
    if not results["complete"]:
        failures["driver"] = f"Blender ended, or was ended, during {results.get('running') or 'the start'}"
    return failures


def report(failures: dict[str, str | None]) -> int:
    """Print a line for each scenario; 1 if one failed."""
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
