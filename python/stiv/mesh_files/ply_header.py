# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a PLY file: its elements with their number and properties."""

from __future__ import annotations

from dataclasses import dataclass, replace

from stiv import InputError

MAX_HEADER_BYTES = 64 * 1024
_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}
_BYTE_ORDERS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Property:
    """A named number in each row or, with a `count_type`, a list of numbers. Types are NumPy's: f4, u1, ..."""

    name: str
    value_type: str
    count_type: str | None = None


@dataclass(frozen=True)
class Element:
    """A table: `count` rows of the properties, in order."""

    name: str
    count: int
    properties: tuple[Property, ...] = ()


@dataclass(frozen=True)
class Header:
    """Elements in file order. `byte_order`: None for text. `size`: bytes before the first element."""

    byte_order: str | None
    elements: tuple[Element, ...]
    size: int


def read_header(data: bytes) -> Header:
    """The header at the start of `data`. Raises InputError naming the line."""
    end = data.find(b"end_header", 0, MAX_HEADER_BYTES)
    line_end = data.find(b"\n", end)
    if not data.startswith(b"ply") or end < 0 or line_end < 0:
        raise InputError("not a PLY file: no header from `ply` to `end_header`")
    byte_order: str | None = None
    elements: list[Element] = []
    lines = data[:end].decode("ascii", errors="replace").splitlines()
    for number, line in enumerate(lines[1:], 2):
        words = line.split()
        try:
            if words[:1] == ["format"]:
                byte_order = _BYTE_ORDERS[words[1]]
            elif words[:1] == ["element"]:
                elements.append(_element(words))
            elif words[:1] == ["property"]:
                elements[-1] = replace(elements[-1], properties=(*elements[-1].properties, _property(words)))
        except (KeyError, IndexError, ValueError) as error:
            raise InputError(f"line {number} of its header is invalid: {line.strip()[:80]!r}") from error
    _refuse_repeated_names(elements)
    return Header(byte_order, tuple(elements), line_end + 1)


def _element(words: list[str]) -> Element:
    count = int(words[2])
    if not 0 <= count < 2**31:
        raise ValueError(count)
    return Element(words[1], count)


def _property(words: list[str]) -> Property:
    if words[1] == "list":
        return Property(words[4], _TYPES[words[3]], _TYPES[words[2]])
    return Property(words[2], _TYPES[words[1]])


def _refuse_repeated_names(elements: list[Element]) -> None:
    for element in elements:
        if not element.properties and element.count:
            raise InputError(f'element "{element.name}": has rows without properties')
        if len({prop.name for prop in element.properties}) < len(element.properties):
            raise InputError(f'element "{element.name}": two properties have the same name')
