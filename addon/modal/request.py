# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that an edit begins with; another request needs another edit."""

from __future__ import annotations

from dataclasses import dataclass, replace

KIND_KEYS = {"G": "move", "R": "rotate", "S": "scale"}
RESPONDERS = ("selected", "unselected", "all")
RESPONSES = ("slide", "slide_and_turn", "deform")


@dataclass(frozen=True)
class Request:
    """The settings of one edit.

    Attributes:
        kind: "move", "rotate" or "scale".
        responders: which side yields, one of RESPONDERS.
        interference: whether surfaces collide.
        response: how objects respond to contact, one of RESPONSES.

    """

    kind: str = "move"
    responders: str = "selected"
    interference: bool = True
    response: str = "slide"

    def with_next_responders(self) -> Request:
        """The request in which another side yields."""
        return replace(self, responders=RESPONDERS[(RESPONDERS.index(self.responders) + 1) % len(RESPONDERS)])

    def with_next_response(self) -> Request:
        """The request in which objects respond in another way."""
        return replace(self, response=RESPONSES[(RESPONSES.index(self.response) + 1) % len(RESPONSES)])
