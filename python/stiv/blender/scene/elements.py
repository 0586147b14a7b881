# SPDX-License-Identifier: GPL-3.0-or-later
"""Elements of evaluated meshes as messages and reports name them, and pairs of elements that intersect."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Indices, split_by_number
from stiv.blender.scene.evaluations import SHOWN

PART = "\t"  # between the name of an object and the number of a part


@dataclass(frozen=True)
class Element:
    """A face, edge or vertex of an object's evaluated mesh, or a strand; `kind` says which.

    evaluation: "shown", or "viewport" (Object Mode) or "render" for elements that are not shown now.
    part: of a mesh that an edit divides.
    """

    object: str
    kind: str
    number: int
    evaluation: str = SHOWN
    part: int = 0

    @property
    def side(self) -> str:
        """Name of the object; extended for all parts of a divided mesh but the first."""
        return f"{self.object}{PART}{self.part}" if self.part else self.object


@dataclass(frozen=True)
class FacePair:
    """Two intersecting elements, the second a face, and the number of their intersecting triangles."""

    first: Element
    second: Element
    triangle_pairs: int = field(default=1, compare=False)


class FacePairs(Sequence[FacePair]):
    """Intersecting pairs of elements as arrays, since a copy of a mesh in the place of the original makes millions.

    Attributes:
        owners: what elements have in common, as elements with the number 0; each once.
        owner: the owner of both elements of each pair, (k, 2).
        number: the numbers of both elements, (k, 2).
        triangle_pairs: of each pair, (k,).
        touching: names of each two different objects, ascending, that are known to touch from outside, and not to cut.
    """

    def __init__(
        self,
        owners: Sequence[Element],
        owner: Indices,
        number: Indices,
        triangle_pairs: Indices,
        touching: frozenset[tuple[str, str]] = frozenset(),
    ) -> None:
        """Take pairs that occur once."""
        self.owners = tuple(owners)
        self.owner = owner
        self.number = number
        self.triangle_pairs = triangle_pairs
        self.touching = touching

    @staticmethod
    def of(pairs: Iterable[FacePair]) -> FacePairs:
        """The same pairs as arrays."""
        if isinstance(pairs, FacePairs):
            return pairs
        listed = list(pairs)
        owners: dict[Element, int] = {}
        elements = [each for pair in listed for each in (pair.first, pair.second)]
        owner = [owners.setdefault(replace(each, number=0), len(owners)) for each in elements]
        number = [each.number for each in elements]
        counts = np.array([pair.triangle_pairs for pair in listed], np.int32)
        return FacePairs(list(owners), _as_pairs(owner), _as_pairs(number), counts)

    def joined(self, others: Iterable[FacePair]) -> FacePairs:
        """These pairs and others, each once; triangles of equal pairs are added."""
        after = FacePairs.of(others)
        if not len(after):
            return self
        place = {owner: number for number, owner in enumerate(dict.fromkeys((*self.owners, *after.owners)))}
        places = np.array([place[owner] for owner in after.owners], np.int32)
        owner, number = np.concatenate([self.owner, places[after.owner]]), np.concatenate([self.number, after.number])
        pairs, numbers = FacePairs.merged(list(place), owner, number)
        counts = np.bincount(numbers, np.concatenate([self.triangle_pairs, after.triangle_pairs]), len(pairs))
        return FacePairs(pairs.owners, pairs.owner, pairs.number, counts.astype(np.int32))

    @staticmethod
    def merged(owners: Sequence[Element], owner: Indices, number: Indices) -> tuple[FacePairs, Indices]:
        """Pairs of which some are equal, whichever element is first; also the number of the pair in each row, (k,).

        Each pair occurs once, in the order and with the first element of its first row.
        """
        elements, places = np.unique(_codes(owner, number), return_inverse=True)
        both = places.reshape(-1, 2)
        keys = both.min(axis=1) * np.int64(len(elements)) + both.max(axis=1)
        firsts, numbers = _distinct(keys)
        counts = np.bincount(numbers, minlength=len(firsts)).astype(np.int32)
        return FacePairs(owners, owner[firsts], number[firsts], counts), numbers

    def __len__(self) -> int:
        """Return the number of pairs."""
        return len(self.owner)

    @overload
    def __getitem__(self, index: int) -> FacePair: ...

    @overload
    def __getitem__(self, index: slice) -> FacePairs: ...

    def __getitem__(self, index: int | slice) -> FacePair | FacePairs:
        """Return a pair, or some of them."""
        if isinstance(index, slice):
            return self.chosen(index)
        return next(iter(self.chosen(np.array([index]))))

    def __iter__(self) -> Iterator[FacePair]:
        """Iterate over the pairs."""
        rows = zip(self.owner.tolist(), self.number.tolist(), self.triangle_pairs.tolist(), strict=True)
        for (first, second), (i, j), count in rows:
            yield FacePair(_numbered(self.owners[first], i), _numbered(self.owners[second], j), count)

    def __eq__(self, other: object) -> bool:
        """Return whether a sequence has the same pairs in the same order."""
        return isinstance(other, Sequence) and len(self) == len(other) and all(map(FacePair.__eq__, self, other))

    __hash__ = None  # type: ignore[assignment]

    def chosen(self, rows: slice | NDArray[np.integer[Any]] | NDArray[np.bool_]) -> FacePairs:
        """Some of the pairs, by number or flag."""
        return FacePairs(self.owners, self.owner[rows], self.number[rows], self.triangle_pairs[rows], self.touching)

    def cutting(self) -> FacePairs:
        """The pairs without those of objects that only touch."""

        def cut(first: Element, second: Element) -> bool:
            return objects_of(first, second) not in self.touching

        return self.chosen(self.where(cut)) if self.touching else self

    def where(self, holds: Callable[[Element, Element], bool]) -> NDArray[np.bool_]:
        """Flags the pairs, (k,), whose owners have a property."""
        owners, numbers = self._pairs_of_owners()
        return np.array([holds(*both) for both in owners], np.bool_)[numbers]

    def by_objects(self) -> dict[tuple[str, str], FacePairs]:
        """The pairs of each two objects, whose names are in ascending order, or of one."""
        owners, numbers = self._pairs_of_owners()
        names: dict[tuple[str, str], int] = {}
        groups = np.empty(len(owners), np.int64)
        for number, (first, second) in enumerate(owners):
            groups[number] = names.setdefault(objects_of(first, second), len(names))
        rows = split_by_number(groups[numbers])
        return {both: self.chosen(own) for both, own in zip(names, rows, strict=False)}

    def _pairs_of_owners(self) -> tuple[list[tuple[Element, Element]], Indices]:
        """The different pairs of owners in the order of their first pair, and the number of its owners for each."""
        firsts, numbers = _distinct(_codes(self.owner[:, 0], self.owner[:, 1]))
        return [(self.owners[a], self.owners[b]) for a, b in self.owner[firsts].tolist()], numbers

    def sides(self) -> set[frozenset[str]]:
        """The objects of each pair, or the parts of a divided mesh."""
        return {sides_of(*both) for both in self._pairs_of_owners()[0]}

    def faces(self) -> list[tuple[Element, Indices]]:
        """Each owner of faces with the numbers of its faces, ascending."""
        codes = np.unique(_codes(self.owner, self.number))
        present, firsts = np.unique(codes >> 32, return_index=True)
        numbers = np.split((codes & 0xFFFFFFFF).astype(np.int32), firsts[1:])
        owned = zip(present.tolist(), numbers, strict=False)
        return [(self.owners[k], own) for k, own in owned if self.owners[k].kind == "face"]


def objects_of(first: Element, second: Element) -> tuple[str, str]:
    """The objects of two elements, ascending."""
    a, b = sorted((first.object, second.object))
    return a, b


def sides_of(first: Element, second: Element) -> frozenset[str]:
    """The objects of two elements, or the parts of a divided mesh."""
    return frozenset((first.side, second.side))


def _numbered(owner: Element, number: int) -> Element:
    return Element(owner.object, owner.kind, number, owner.evaluation, owner.part)


def _as_pairs(values: Sequence[int]) -> Indices:
    return np.array(values, np.int32).reshape(-1, 2)


def _codes(owner: Indices, number: Indices) -> NDArray[np.int64]:
    """A number for each element."""
    return (owner.astype(np.int64) << 32) + number


def _distinct(keys: NDArray[np.int64]) -> tuple[Indices, Indices]:
    """The first row of each different key, ascending, and for each row the number of its key."""
    _, firsts, inverse = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(firsts)
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    return firsts[order].astype(np.int32), rank[inverse.reshape(-1)]


def count_faces(pairs: Iterable[FacePair]) -> int:
    """Number of different faces in the pairs: of those that are shown, if there are any."""
    faces = FacePairs.of(pairs).faces()
    return sum(len(numbers) for owner, numbers in faces if owner.evaluation == SHOWN) or sum(
        len(numbers) for _, numbers in faces
    )
