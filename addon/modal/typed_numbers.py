# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers typed during a drag: one for each component; Tab switches to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from .event import Event

MAX_DIGITS = 12
MAX_EXPRESSION = 40

_WORDS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
_CHARACTERS = (
    {word: str(digit) for digit, word in enumerate(_WORDS)}
    | {f"NUMPAD_{digit}": str(digit) for digit in range(10)}
    | {"PERIOD": ".", "NUMPAD_PERIOD": ".", "COMMA": ".", "MINUS": "-", "NUMPAD_MINUS": "-", "BACK_SPACE": "\b"}
    | {"SLASH": "/", "NUMPAD_SLASH": "/"}
)
_EXPRESSION_CHARACTERS = {"NUMPAD_PLUS": "+", "NUMPAD_ASTERIX": "*", "SPACE": " "}

Read = Callable[[str], float]  # the value of a text with units; ValueError for an invalid text


def typed_character(event: Event) -> str:
    """The character that an event adds to a number: a digit, ".", "-", "/", backspace, or none."""
    if event.modifiers & {"ctrl", "alt", "oskey"}:
        return ""
    if len(event.text) == 1 and event.text in "0123456789.-/":
        return event.text
    return _CHARACTERS.get(event.type, "")


def expression_character(event: Event) -> str:
    """The character that an event adds to an expression: any printable one, or backspace."""
    if event.modifiers & {"ctrl", "oskey"}:
        return ""
    if len(event.text) == 1 and event.text.isprintable():
        return event.text
    letter = event.type.lower() if len(event.type) == 1 else ""
    return _CHARACTERS.get(event.type, "") or _EXPRESSION_CHARACTERS.get(event.type, "") or letter


@dataclass(frozen=True)
class TypedNumber:
    """Digits, a sign that "-" toggles and an inversion that "/" toggles at any time, as in Blender.

    An `expression` is the text alone, with "-" and "/" like any other character.
    """

    digits: str = ""
    negative: bool = False
    inverse: bool = False
    expression: bool = False

    @property
    def active(self) -> bool:
        """Whether anything is typed; it then overrides the pointer."""
        return bool(self.digits) or self.negative or self.inverse

    def value(self, read: Read = float) -> float | None:
        """The number, None before the first digit. ValueError for an invalid expression and for 1/0."""
        if not (self.digits.strip() if self.expression else any(character.isdigit() for character in self.digits)):
            return None
        value = read(self.digits)
        if self.inverse:
            if value == 0.0:
                raise ValueError("1/0 is not a number")
            value = 1.0 / value
        return -value if self.negative else value

    @property
    def text(self) -> str:
        """The text as typed, for display."""
        return ("-" if self.negative else "") + ("1/" if self.inverse else "") + self.digits

    def typed(self, character: str) -> TypedNumber:
        """The number after one more character."""
        if character == "\b":
            return self._shortened()
        if self.expression:
            return self if len(self.digits) >= MAX_EXPRESSION else replace(self, digits=self.digits + character)
        if character == "-":
            return replace(self, negative=not self.negative)
        if character == "/":
            return replace(self, inverse=not self.inverse)
        if len(self.digits) >= MAX_DIGITS or (character == "." and "." in self.digits):
            return self
        return replace(self, digits=self.digits + character)

    def as_expression(self) -> TypedNumber:
        """The number as an expression, with sign and inversion as characters of the text."""
        return self if self.expression else TypedNumber(self.text, expression=True)

    def _shortened(self) -> TypedNumber:
        """Without the last digit; if there is none, without sign and inversion."""
        if not self.digits:
            return TypedNumber(expression=self.expression)
        return replace(self, digits=self.digits[:-1])


COMPONENTS = 3


@dataclass(frozen=True)
class TypedValues:
    """The numbers and the index of the current one. `expression`: letters and operators are accepted too."""

    numbers: tuple[TypedNumber, ...] = (TypedNumber(),) * COMPONENTS
    index: int = 0
    expression: bool = False

    @property
    def active(self) -> bool:
        """Whether anything is typed."""
        return any(number.active for number in self.numbers)

    def typed(self, character: str) -> TypedValues:
        """With a character added to the current number; backspace in an empty number selects the previous one."""
        number = self.numbers[self.index]
        if character == "\b" and not number.active and self.index > 0:
            return replace(self, index=self.index - 1)
        return self._with(number.typed(character))

    def moved_on(self, count: int) -> TypedValues:
        """With the next of `count` numbers as the current one, cyclically."""
        return replace(self, index=(self.index + 1) % count)._converted()

    def limited(self, count: int) -> TypedValues:
        """With only the first `count` numbers."""
        numbers = tuple(number if i < count else TypedNumber() for i, number in enumerate(self.numbers))
        return replace(self, numbers=numbers, index=min(self.index, count - 1))

    def as_expression(self) -> TypedValues:
        """With letters and operators accepted from now on."""
        return replace(self, expression=True)._converted()

    def value(self, index: int, read: Read) -> float | None:
        """One of the numbers, None if it is empty. ValueError for an invalid one."""
        return self.numbers[index].value(read)

    def text(self, count: int) -> str:
        """The numbers as typed, for display; the current one has a cursor."""
        shown = [number.text + ("|" if i == self.index else "") for i, number in enumerate(self.numbers[:count])]
        last = max([self.index, *(i for i, number in enumerate(self.numbers) if number.active)])
        return " ".join(f"[{text}]" for text in shown[: last + 1])

    def _converted(self) -> TypedValues:
        return self._with(self.numbers[self.index].as_expression()) if self.expression else self

    def _with(self, number: TypedNumber) -> TypedValues:
        numbers = list(self.numbers)
        numbers[self.index] = number
        return replace(self, numbers=tuple(numbers))
