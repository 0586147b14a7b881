# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates typed expressions: + - * / ** ( ), pi, and numbers with units. No names are looked up or called."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

MAX_LENGTH = 60

_TOKEN = re.compile(r"\s*(?:(\d+\.?\d*|\.\d+)|(\*\*|[-+*/()^])|([A-Za-zµμ°]+|'{1,2}|\"))")

Units = Callable[[str], float | None]  # the factor of a unit, None if unknown; "" is the unit of plain numbers


def evaluate(text: str, units: Units) -> float:
    """The value of an expression. If no number has a unit, the value is in the unit "".

    Raises ValueError with the reason for an invalid expression.
    """
    if len(text) > MAX_LENGTH:
        raise ValueError(f"the expression is longer than {MAX_LENGTH} characters")
    reader = _Reader(_tokens(text), units)
    try:
        value = reader.all()
    except (OverflowError, ZeroDivisionError):
        value = math.nan
    if not isinstance(value, float) or not math.isfinite(value):
        raise ValueError(f"{text!r} is not a finite number")
    return value if reader.has_units else value * (units("") or 1.0)


def _tokens(text: str) -> list[str]:
    tokens, place = [], 0
    text = text.rstrip()
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            raise ValueError(f"unexpected {text[place]!r}")
        tokens.append(match.group().strip())
        place = match.end()
    return tokens


class _Reader:
    """Recursive descent over tokens; the last one is "", the end."""

    def __init__(self, tokens: list[str], units: Units):
        self.has_units = False
        self._tokens = [*tokens, ""]
        self._units = units
        self._place = 0

    def all(self) -> float:
        value = self._sum()
        if self._next():
            raise ValueError(f"unexpected {self._next()!r}")
        return value

    def _next(self) -> str:
        return self._tokens[self._place]

    def _taken(self, *wanted: str) -> str:
        """Consumes the next token if it is one of those wanted; otherwise returns an empty text."""
        token = self._next()
        if token not in wanted or not token:
            return ""
        self._place += 1
        return token

    def _sum(self) -> float:
        value = self._product()
        while operator := self._taken("+", "-"):
            other = self._product()
            value = value + other if operator == "+" else value - other
        return value

    def _product(self) -> float:
        value = self._signed()
        while operator := self._taken("*", "/"):
            other = self._signed()
            value = value * other if operator == "*" else value / other
        return value

    def _signed(self) -> float:
        if self._taken("-"):
            return -self._signed()
        if self._taken("+"):
            return self._signed()
        return self._power()

    def _power(self) -> float:
        base = self._atom()
        return base ** self._signed() if self._taken("**", "^") else base  # `evaluate` rejects complex results

    def _atom(self) -> float:
        if self._taken("("):
            value = self._sum()
            if not self._taken(")"):
                raise ValueError("missing )")
            return value
        if self._taken("pi"):
            return math.pi
        return self._quantities()

    def _quantities(self) -> float:
        """A number, or a sequence of numbers with units: 1m 20cm."""
        value, has_unit = self._quantity()
        while has_unit and (self._next()[:1].isdigit() or self._next().startswith(".")):
            following, has_unit = self._quantity()
            value += following
        return value

    def _quantity(self) -> tuple[float, bool]:
        """A number, and whether it has a unit."""
        token = self._next()
        if not (token[:1].isdigit() or token.startswith(".")):
            raise ValueError(f"missing number before {token!r}" if token else "missing number")
        self._place += 1
        unit = self._next()
        if not unit or unit[0].isdigit() or unit[0] in ".+-*/()^":
            return float(token), False
        factor = self._units(unit)
        if factor is None:
            raise ValueError(f"unknown unit {unit!r}")
        self._place += 1
        self.has_units = True
        return float(token) * factor, True
