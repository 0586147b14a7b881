# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of several calls of a session as one."""

from collections.abc import Sequence
from dataclasses import replace

import stiv


def summed(results: Sequence[stiv.EditResult]) -> stiv.EditResult:
    """The last result, with the work of all; a settling that found nothing to do leaves the status before it."""
    last = results[-1]
    told = [result for result in results if result.status != "unchanged"]
    with_events = [result for result in results if len(result.events)]
    return replace(
        last,
        status=told[-1].status if told else last.status,
        fraction=min(result.fraction for result in results),
        rounds=sum(result.rounds for result in results),
        events=with_events[-1].events if with_events else last.events,
        patches=with_events[-1].patches if with_events else last.patches,
        timings={name: sum(result.timings[name] for result in results) for name in last.timings},
        counters={name: sum(result.counters[name] for result in results) for name in last.counters},
    )
