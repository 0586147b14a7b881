# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers typed during a drag: one for each component, Tab goes from one to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .typed_number import Read, TypedNumber

COMPONENTS = 3


@dataclass(frozen=True)
class TypedValues:
    """Numbers, and which of them is being typed. `expression`: whether letters and operators are typed as well."""

    numbers: tuple[TypedNumber, ...] = (TypedNumber(),) * COMPONENTS
    index: int = 0
    expression: bool = False

    @property
    def active(self) -> bool:
        """Whether anything is typed."""
        return any(number.active for number in self.numbers)

    def typed(self, character: str) -> TypedValues:
        """After one more character for the present number; backspace in an empty one goes back to the one before."""
        number = self.numbers[self.index]
        if character == "\b" and not number.active and self.index > 0:
            return replace(self, index=self.index - 1)
        return self._with(number.typed(character))

    def moved_on(self, count: int) -> TypedValues:
        """The next of `count` numbers, the first one after the last."""
        return replace(self, index=(self.index + 1) % count)._in_its_way()

    def limited(self, count: int) -> TypedValues:
        """With no number after the first `count`."""
        kept = tuple(number if i < count else TypedNumber() for i, number in enumerate(self.numbers))
        return replace(self, numbers=kept, index=min(self.index, count - 1))

    def as_expression(self) -> TypedValues:
        """From now on letters and operators are typed too."""
        return replace(self, expression=True)._in_its_way()

    def value(self, index: int, read: Read) -> float | None:
        """One of the numbers, None where none is typed. ValueError for what is not a number."""
        return self.numbers[index].value(read)

    def text(self, count: int) -> str:
        """As typed, for display: the present one with a cursor."""
        shown = [number.text + ("|" if i == self.index else "") for i, number in enumerate(self.numbers[:count])]
        last = max([self.index, *(i for i, number in enumerate(self.numbers) if number.active)])
        return " ".join(f"[{text}]" for text in shown[: last + 1])

    def _in_its_way(self) -> TypedValues:
        return self._with(self.numbers[self.index].as_expression()) if self.expression else self

    def _with(self, number: TypedNumber) -> TypedValues:
        numbers = list(self.numbers)
        numbers[self.index] = number
        return replace(self, numbers=tuple(numbers))
