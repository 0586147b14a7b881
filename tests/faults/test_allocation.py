# SPDX-License-Identifier: GPL-3.0-or-later
"""Failed allocations during an edit: an error, and the session is unchanged."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("resource", reason="limits of processes are POSIX")

SCRIPT = """\
import resource, sys
sys.path[:0] = {path!r}
import numpy as np
import stiv
from ball_above_wall import session
editing, other = session(threads=1), session(threads=1)
controls, surface = editing.controls, editing.surface
goal = controls + (0.02, 0.01, -0.45)
pages = int(open("/proc/self/statm").read().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + {spare}, resource.RLIM_INFINITY))
try:
    said = editing.drag(goal).status
except MemoryError:
    said = "MemoryError"
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
if said == "MemoryError":
    assert np.array_equal(editing.controls, controls) and np.array_equal(editing.surface, surface)
    assert np.array_equal(editing.drag(goal).controls, other.drag(goal).controls)
print(said)
"""


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads its size from /proc")
@pytest.mark.parametrize("megabytes", [2, 12])
def test_an_edit_without_memory_does_not_change_the_session(megabytes):
    path = [str(Path(__file__).parent), str(Path(__file__).parents[2]), *sys.path]
    script = SCRIPT.format(path=path, spare=megabytes * 10**6)
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=600, check=False)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.split() == ["MemoryError"]
