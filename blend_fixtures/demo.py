# SPDX-License-Identifier: GPL-3.0-or-later
"""Lowers a bunch of shoots into a vase and scales it up there, through the add-on's operators.

    python blend_fixtures/demo.py [--output build/demo]

Writes before.png, after.png, after.blend and report.json; ends by checking after.blend exactly, in a process of its
own. Needs Blender as a Python module and the package `stiv` with its add-on.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.blender.blend_files import open_blend, render_picture, save_blend
from stiv.command_line.output_files import write_json, written_atomically
from stiv.command_line.quiet import quiet_blender
from stiv.command_line.replay import replay_report, run_script
from stiv.edit_scripts import read_edit_script

MEDIANS = {"milliseconds": "ms an edit", "rounds": "rounds", "events": "events", "patches": "patches"}
SCENE = Path(__file__).resolve().parent / "plant_in_vase.blend"


def run(output: Path) -> list[dict[str, Any]]:
    """Runs the demo's edits and writes its files into `output`; what each edit did."""
    output.mkdir(parents=True, exist_ok=True)
    script = read_edit_script(SCENE.with_suffix(".edits.json"))
    with quiet_blender():
        open_blend(SCENE)
        _render(output / "before.png")
        edits = run_script(script, SCENE)
        with written_atomically(output / "after.blend") as temporary:
            save_blend(temporary)
        _render(output / "after.png")
    write_json(output / "report.json", replay_report(SCENE, edits))
    return edits


def _render(path: Path) -> None:
    with written_atomically(path) as temporary, quiet_blender(errors=True):
        render_picture(temporary)


def check(blend: Path) -> int:
    """Exit code of `stiv check` on the saved file, which a fresh process loads anew."""
    return subprocess.run([sys.executable, "-m", "stiv.command_line", "check", str(blend)], check=False).returncode


def summary(edits: list[dict[str, Any]], seconds: float) -> str:
    """What the demo did, in a few lines."""
    touching = [edit for edit in edits if edit["rounds"] > 0]
    rounds = [1000 * edit["timings"]["total"] / edit["counters"]["detections"] for edit in touching]
    lines = [f"{len(edits)} edits, {len(touching)} of them met resistance, {seconds:.0f} s in all"]
    if touching:
        median = {key: statistics.median(edit[key] for edit in touching) for key in MEDIANS}
        named = ", ".join(f"{median[key]:.0f} {unit}" for key, unit in MEDIANS.items())
        lines.append(f"median of those: {named}, {statistics.median(rounds):.1f} ms a round")
    return "\n".join(lines)


def main() -> int:
    """Runs the demo and the check; the exit code is that of the check."""
    parser = argparse.ArgumentParser(description="A plant lowered into a vase without intersections.")
    parser.add_argument("--output", type=Path, default=Path("build/demo"), help="folder for the files it writes")
    output = parser.parse_args().output
    begin = time.perf_counter()
    try:
        edits = run(output)
    except InputError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 2
    code = check(output / "after.blend")
    print(summary(edits, time.perf_counter() - begin))
    print(f"written to {output}: before.png, after.png, after.blend, report.json")
    return code


if __name__ == "__main__":
    exit_code = main()
    sys.stdout.flush()
    os._exit(exit_code)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
