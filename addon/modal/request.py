# SPDX-License-Identifier: GPL-3.0-or-later
"""What an edit of the scene is begun with: another request needs another edit."""

from __future__ import annotations

from dataclasses import dataclass, replace

KIND_KEYS = {"G": "move", "R": "rotate", "S": "scale"}
RESPONDERS = ("selected", "unselected", "all")


@dataclass(frozen=True)
class Request:
    """`kind`: "move", "rotate" or "scale"; `responders`: who gives way; `interference`: whether anything does."""

    kind: str = "move"
    responders: str = "selected"
    interference: bool = True

    def with_next_responders(self) -> Request:
        """Somebody else gives way."""
        return replace(self, responders=RESPONDERS[(RESPONDERS.index(self.responders) + 1) % len(RESPONDERS)])
