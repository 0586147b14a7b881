# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the tables of benchmarks/results/README.md from the JSON files beside it.

Each table is enclosed in `<!-- begin NAME -->` and `<!-- end NAME -->`. `python -m benchmarks.results_tables`
"""

from __future__ import annotations

import re
from collections.abc import Callable

from benchmarks.results_tables import edit_times, energies, session_times
from benchmarks.results_tables.markdown import FOLDER

TABLES: dict[str, Callable[[], str]] = {
    make.__name__: make
    for make in (
        edit_times.table1,
        energies.settled,
        energies.whole_drags,
        energies.fourteen,
        edit_times.detection,
        session_times.frames,
        session_times.frame_shares,
        session_times.drags,
        session_times.growth,
        session_times.large_scenes,
        session_times.long_sessions,
        edit_times.race,
        edit_times.trust_regions,
        session_times.cloth,
        session_times.models,
    )
}


def filled(text: str) -> str:
    """The text with updated tables."""
    for name, make in TABLES.items():
        block = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        text, count = block.subn(lambda match, make=make: match[1] + make() + "\n" + match[2], text)  # type: ignore[misc]
        if count != 1:
            raise ValueError(f"README.md of the results has {count} places for the table {name!r}")
    return text


def main() -> None:
    """Update README.md."""
    path = FOLDER / "README.md"
    path.write_text(filled(path.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
