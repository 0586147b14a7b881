# SPDX-License-Identifier: GPL-3.0-or-later
"""75,592 faces moved by ten diagonals in one step, in a process limited to 2 GB.

STIV_LONG=1 also moves them at an angle, which takes minutes: the ball slides along the wall to the end.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

resource = pytest.importorskip("resource", reason="limits of processes are POSIX")

LIMIT = 2 * 10**9
SCRIPT = """\
import resource, sys
sys.path[:0] = {path!r}
import numpy as np
from ball_above_wall import session, ball_above_wall
resource.setrlimit(resource.RLIMIT_AS, ({limit}, {limit}))
editing = session(threads=2)
diagonal = float(np.linalg.norm(np.ptp(editing.surface, axis=0)))
result = editing.edit(editing.controls + np.array([{direction}]) * 10 * diagonal)
surface, _, _ = ball_above_wall()
import stiv
with open("/proc/self/status") as status:  # ru_maxrss would count what the parent held when it started this process
    peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
print(result.status, len(stiv.find_intersections(result.surface, surface, threads=2)), peak * 1024)
"""


@pytest.mark.parametrize("direction", ["0, 0, -1", "0.8, 0, -0.6"][: 2 if "STIV_LONG" in os.environ else 1])
def test_a_motion_of_ten_diagonals_stays_under_two_gigabytes(direction):
    path = [str(Path(__file__).parent), str(Path(__file__).parents[2]), *sys.path]
    script = SCRIPT.format(path=path, limit=LIMIT, direction=direction)
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=1500, check=False)
    assert ended.returncode == 0, ended.stderr
    status, intersections, peak = ended.stdout.split()
    assert status in ("corrected", "blocked", "reached") and intersections == "0"
    assert int(peak) < LIMIT
