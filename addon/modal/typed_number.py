# SPDX-License-Identifier: GPL-3.0-or-later
"""A number typed during a drag."""

from __future__ import annotations

from dataclasses import dataclass

from .events import Event

MAX_DIGITS = 12

_WORDS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
_CHARACTERS = (
    {word: str(digit) for digit, word in enumerate(_WORDS)}
    | {f"NUMPAD_{digit}": str(digit) for digit in range(10)}
    | {"PERIOD": ".", "NUMPAD_PERIOD": ".", "COMMA": ".", "MINUS": "-", "NUMPAD_MINUS": "-", "BACK_SPACE": "\b"}
)


def typed_character(event: Event) -> str:
    """What an event adds to a number: a digit, ".", "-", backspace, or nothing."""
    if event.modifiers & {"ctrl", "alt", "oskey"}:
        return ""
    if len(event.text) == 1 and event.text in "0123456789.-":
        return event.text
    return _CHARACTERS.get(event.type, "")


@dataclass(frozen=True)
class TypedNumber:
    """Digits typed so far and their sign, which "-" turns at any time, as Blender's own fields do."""

    digits: str = ""
    negative: bool = False

    @property
    def active(self) -> bool:
        """Whether anything is typed, so that the pointer no longer counts."""
        return bool(self.digits) or self.negative

    @property
    def value(self) -> float | None:
        """The number, None until there is a digit."""
        if not any(character.isdigit() for character in self.digits):
            return None
        return -float(self.digits) if self.negative else float(self.digits)

    @property
    def text(self) -> str:
        """As typed, for display."""
        return ("-" if self.negative else "") + self.digits

    def typed(self, character: str) -> TypedNumber:
        """The number after one more character of `typed_character`."""
        if character == "-":
            return TypedNumber(self.digits, not self.negative)
        if character == "\b":
            return TypedNumber(self.digits[:-1], self.negative and bool(self.digits))
        if len(self.digits) >= MAX_DIGITS or (character == "." and "." in self.digits):
            return self
        return TypedNumber(self.digits + character, self.negative)
