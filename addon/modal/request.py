# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that an edit begins with; another request needs another edit."""

from __future__ import annotations

from dataclasses import dataclass, replace

KIND_KEYS = {"G": "move", "R": "rotate", "S": "scale"}
RESPONDERS = ("selected", "unselected", "all")


@dataclass(frozen=True)
class Request:
    """The settings of one edit.

    Attributes:
        kind: "move", "rotate" or "scale".
        responders: which side yields, one of RESPONDERS.
        interference: whether surfaces collide.

    """

    kind: str = "move"
    responders: str = "selected"
    interference: bool = True

    def with_next_responders(self) -> Request:
        """The request in which another side yields."""
        return replace(self, responders=RESPONDERS[(RESPONDERS.index(self.responders) + 1) % len(RESPONDERS)])
