# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages that fit Blender's status bar: the longest names in them are shortened."""

from __future__ import annotations

from collections.abc import Sequence

MESSAGE_LENGTH = 80  # characters of a message in Blender
_LEAST_CHARACTERS = 6  # of a name that is shortened


def fit_message(template: str, *parts: object) -> str:
    """Fill in the template's {}. The longest parts are shortened until the message fits, as far as they can be."""
    texts = [str(part) for part in parts]
    fixed = len(template.format(*[""] * len(texts)))
    most = _most_of_each([len(text) for text in texts], MESSAGE_LENGTH - fixed)
    return template.format(*(_shortened(text, most) for text in texts))


def first_and_others(names: Sequence[str]) -> tuple[str, str]:
    """The first name, and the number of the others as a text: "" or " and 2 more"."""
    return names[0], f" and {len(names) - 1} more" if len(names) > 1 else ""


def _most_of_each(lengths: Sequence[int], room: int) -> int:
    """The most characters of each part with which all parts fill the room."""
    for number, length in enumerate(sorted(lengths)):
        share = room // (len(lengths) - number)
        if length > share:
            return max(share, _LEAST_CHARACTERS)
        room -= length
    return max(lengths, default=0)


def _shortened(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"
