# SPDX-License-Identifier: GPL-3.0-or-later
"""Kill workers and the parent of a batch at random moments, and compare with an undisturbed run.

    python tests/long/batch_kills.py [--scenes 200] [--kills 50] [--seed 1]

Kills alternate between a worker and the parent, after which the job is resumed. The exit code is 1 if an
output differs from that of an undisturbed run, or if the job does not finish. Needs /proc.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "batch")]

from jobs import results, write_job  # noqa: E402

import stiv  # noqa: E402

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(Path(stiv.__file__).parents[1])}


def start(job: Path, *options: str) -> subprocess.Popen:
    command = [sys.executable, "-m", "stiv.command_line", "batch", str(job), "--workers", "2", *options]
    return subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def workers_of(parent: int) -> list[int]:
    try:
        return [int(pid) for pid in Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]
    except OSError:
        return []


def disturb(job: Path, kills: int, longest: float, chance: random.Random) -> tuple[int, int]:
    """Run the job with kills until it finishes; returns the numbers of killed workers and parents."""
    killed_workers = killed_parents = 0
    while True:
        parent = start(job, "--resume")
        while parent.poll() is None and killed_workers + killed_parents < kills:
            time.sleep(chance.uniform(0, longest))
            if (killed_workers + killed_parents) % 2 == 0:
                workers = workers_of(parent.pid)
                if workers:
                    try:
                        os.kill(chance.choice(workers), signal.SIGKILL)
                    except ProcessLookupError:
                        continue
                    killed_workers += 1
            else:
                parent.kill()
                killed_parents += 1
                break
        code = parent.wait()
        if code == 0:
            return killed_workers, killed_parents
        if code not in (-signal.SIGKILL, 3):  # 3: a scene lost its worker twice, and runs again
            raise SystemExit(f"the job ended with {code}")


def main() -> int:
    """Run, kill and compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        one, two = Path(folder, "one"), Path(folder, "two")
        one.mkdir(), two.mkdir()
        begin = time.monotonic()
        if start(write_job(one, chosen.scenes)).wait() != 0:
            raise SystemExit("the undisturbed run failed")
        alone = time.monotonic() - begin
        job = write_job(two, chosen.scenes)
        workers, parents = disturb(job, chosen.kills, 3 * alone / max(chosen.kills, 1), random.Random(chosen.seed))
        wanted, found = results(one), results(two)
    different = sum(found.get(name) != data for name, data in wanted.items())
    spare = sorted(set(found) - set(wanted))
    print(f"{chosen.scenes} scenes, {alone:.0f} s undisturbed; killed {workers} workers and {parents} parents")
    print(f"{different} outputs differ, {len(spare)} files too many {spare[:3]}")
    return int(different > 0 or bool(spare))


if __name__ == "__main__":
    raise SystemExit(main())
