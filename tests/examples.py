# SPDX-License-Identifier: GPL-3.0-or-later
"""How many random examples a test runs: all of them, or a fraction where an emulator makes each one slow."""

import os

FRACTION = float(os.environ.get("STIV_EXAMPLES", "1"))  # tools/test_arm64.sh sets it
FEWEST = 5


def examples(count: int) -> int:
    """This many, or the fraction of STIV_EXAMPLES, but at least five."""
    return max(min(count, FEWEST), round(count * FRACTION))
