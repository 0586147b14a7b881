# SPDX-License-Identifier: GPL-3.0-or-later
"""Excluded pairs of faces, which may intersect, as arrays: two equal meshes in one place have millions."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.blender.scene.arrays import split_by_number

Keys = NDArray[np.int64]
Rows = NDArray[np.int64]

FaceKey = tuple[str, int]
"""Name of an object, and number of a face of its evaluated mesh; a number that no face has for loose elements."""


def _no_rows() -> Rows:
    return np.empty((0, 4), np.int64)


@dataclass(frozen=True, eq=False)
class Exclusions:
    """Excluded pairs of faces, which may intersect; made by `of` or `of_pairs`.

    Pairs within an object stay as they are. Two objects with an excluded pair may part in any direction, and overlap no
    more than at the start of an edit.

    Attributes:
        names: of the objects in the pairs, ascending; followed by a line break and "render" where only the render
            shows the mesh.
        rows: both faces of each pair, the smaller key first: index into `names` and number, twice, (k, 4). Ascending.
        shapes: digest of the faces of each object by name. The pairs of an object with another digest are stale.
    """

    names: tuple[str, ...] = ()
    rows: Rows = field(default_factory=_no_rows)
    shapes: Mapping[str, str] = field(default_factory=dict)

    @staticmethod
    def of(names: Sequence[str], rows: Rows, shapes: Mapping[str, str] | None = None) -> Exclusions:
        """Pairs in any order, (k, 4), also several times, whose names may repeat."""
        used = sorted({names[k] for k in np.unique(rows[:, ::2]).tolist()})
        place = {name: number for number, name in enumerate(used)}
        places = np.array([place.get(name, -1) for name in names], np.int64)
        keys = _keys(places[rows[:, ::2]], rows[:, 1::2])
        elements, pairs = np.unique(keys, return_inverse=True)
        codes = np.unique(_codes(pairs.reshape(-1, 2), len(elements)))
        both = elements[np.stack(np.divmod(codes, max(1, len(elements))), axis=1)]
        ordered = np.stack([both >> 32, (both & 0xFFFFFFFF) - 1], axis=2).reshape(-1, 4)
        return Exclusions(tuple(used), ordered, dict(shapes or {}))

    @staticmethod
    def of_pairs(pairs: Iterable[tuple[FaceKey, FaceKey]], shapes: Mapping[str, str] | None = None) -> Exclusions:
        """The pairs as arrays."""
        keys = list(chain.from_iterable(pairs))
        numbers = np.array([number for _, number in keys], np.int64)
        rows = np.stack([np.arange(len(keys), dtype=np.int64), numbers], axis=1).reshape(-1, 4)
        return Exclusions.of([name for name, _ in keys], rows, shapes)

    def __len__(self) -> int:
        """Return the number of pairs."""
        return len(self.rows)

    def __eq__(self, other: object) -> bool:
        """Return whether pairs and digests are the same."""
        if self is other or not isinstance(other, Exclusions):
            return self is other
        same = self.names == other.names and np.array_equal(self.rows, other.rows)
        return same and dict(self.shapes) == dict(other.shapes)

    __hash__ = None  # type: ignore[assignment]

    @property
    def face_count(self) -> int:
        """Number of different faces in the pairs."""
        return len(self._elements)

    @cached_property
    def pairs(self) -> frozenset[tuple[FaceKey, FaceKey]]:
        """Both faces of each pair, the smaller key first."""
        names = self.names
        return frozenset(((names[a], i), (names[b], j)) for a, i, b, j in self.rows.tolist())

    @cached_property
    def faces(self) -> Mapping[tuple[str, str], Keys]:
        """A number for each excluded face of each two objects, or parts of an object, whose names are in ascending
        order.
        """
        keys, count = _keys(self.rows[:, ::2], self.rows[:, 1::2]), len(self.names)
        codes, numbers = np.unique(self.rows[:, 0] * count + self.rows[:, 2], return_inverse=True)
        found: dict[tuple[str, str], list[Keys]] = {}
        for code, rows in zip(codes.tolist(), split_by_number(numbers.reshape(-1)), strict=False):
            a, b = sorted(self.names[k].partition("\n")[0] for k in divmod(code, count))
            found.setdefault((a, b), []).append(keys[rows].ravel())
        return {names: np.unique(np.concatenate(each)) for names, each in found.items()}

    @cached_property
    def objects(self) -> frozenset[tuple[str, str]]:
        """Pairs of different objects with excluded faces, in ascending order."""
        return frozenset(names for names in self.faces if names[0] != names[1])

    def within(self, name: str) -> Rows:
        """The excluded pairs of different faces of one object, by the name in their keys, ascending, (m, 2)."""
        place = self.names.index(name) if name in self.names else -1
        rows = self.rows[(self.rows[:, 0] == place) & (self.rows[:, 2] == place) & (self.rows[:, 1] != self.rows[:, 3])]
        within: Rows = rows[:, 1::2]
        return within

    def contains(self, names: Sequence[str], rows: Rows) -> NDArray[np.bool_]:
        """Flags the excluded ones of pairs, (k,); `names` and `rows`, (k, 4), as those of `of`."""
        if len(self.rows) == 0 or len(rows) == 0:
            return np.zeros(len(rows), np.bool_)
        place = {name: number for number, name in enumerate(self.names)}
        places = np.array([place.get(name, -1) for name in names], np.int64)
        keys = _keys(places[rows[:, ::2]], rows[:, 1::2])
        numbers, known = _find(self._elements, keys)
        _, found = _find(self._pair_codes, _codes(numbers, len(self._elements)))
        return np.asarray(known.all(axis=1) & found, np.bool_)

    def joined(self, names: Sequence[str], rows: Rows) -> Exclusions:
        """These pairs and others, `names` and `rows`, (k, 4), as those of `of`."""
        shifted = rows.astype(np.int64)
        shifted[:, ::2] += len(self.names)
        return Exclusions.of([*self.names, *names], np.concatenate([self.rows, shifted]), self.shapes)

    def without(self, names: Collection[str]) -> Exclusions:
        """The pairs, and the digests, of other objects."""
        kept = np.array([name not in names for name in self.names], np.bool_)
        rows = self.rows[kept[self.rows[:, ::2]].all(axis=1)]
        return Exclusions.of(
            self.names, rows, {name: shape for name, shape in self.shapes.items() if name not in names}
        )

    @cached_property
    def _elements(self) -> Keys:
        return np.unique(_keys(self.rows[:, ::2], self.rows[:, 1::2]))

    @cached_property
    def _pair_codes(self) -> Keys:
        """Ascending, as the rows are."""
        numbers = np.searchsorted(self._elements, _keys(self.rows[:, ::2], self.rows[:, 1::2]))
        return _codes(numbers, len(self._elements))

    @staticmethod
    @lru_cache(maxsize=2)
    def from_json(text: str) -> Exclusions:
        """Read the text of `to_json`; "" gives no pairs. Raises InputError for any other text."""
        if not text:
            return Exclusions()
        try:
            data = json.loads(text)
            pairs = [((str(a), int(i)), (str(b), int(j))) for a, i, b, j in data["pairs"]]
            return Exclusions.of_pairs(pairs, {str(name): str(shape) for name, shape in data["shapes"].items()})
        except (ValueError, TypeError, KeyError, AttributeError, OverflowError) as error:
            raise InputError("the scene's excluded pairs cannot be read; use Clear Excluded Collisions") from error

    def to_json(self) -> str:
        """Text for a property of the scene; "" for no pairs."""
        if not len(self.rows):
            return ""
        pairs = [[self.names[a], i, self.names[b], j] for a, i, b, j in self.rows.tolist()]
        return json.dumps({"pairs": pairs, "shapes": {**self.shapes}})


def _keys(place: Keys, number: Keys) -> Keys:
    """A number for each face, in the order of its key. Loose elements have the number -1."""
    return (place.astype(np.int64) << 32) + number + 1


def _codes(pairs: NDArray[np.int64], count: int) -> Keys:
    """A number for each pair, (k, 2), of numbers below `count`."""
    codes: Keys = pairs.min(axis=1) * np.int64(count) + pairs.max(axis=1)
    return codes


def _find(ascending: Keys, values: Keys) -> tuple[Keys, NDArray[np.bool_]]:
    """The place of each value, and whether it is there."""
    places = np.minimum(np.searchsorted(ascending, values), len(ascending) - 1)
    return places, ascending[places] == values
