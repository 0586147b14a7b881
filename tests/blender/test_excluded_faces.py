# SPDX-License-Identifier: GPL-3.0-or-later
"""Excluded pairs as arrays, against sets of pairs."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from stiv.blender import Exclusions
from stiv.blender.excluded_faces import FaceKey

Pair = tuple[FaceKey, FaceKey]

keys = st.tuples(st.sampled_from(["A", "B", "B\t1", "C\nrender"]), st.integers(-1, 3))
pairs_of_keys = st.lists(st.tuples(keys, keys), max_size=12)


def ascending(pairs: list[Pair]) -> set[Pair]:
    return {(a, b) if a <= b else (b, a) for a, b in pairs}


def as_arrays(pairs: list[Pair]) -> tuple[list[str], np.ndarray]:
    """Each key with a name of its own."""
    flat = [key for pair in pairs for key in pair]
    rows = np.array([[index, number] for index, (_, number) in enumerate(flat)], np.int64).reshape(-1, 4)
    return [name for name, _ in flat], rows


@given(pairs_of_keys, pairs_of_keys)
def test_exclusions_are_those_of_a_set(some: list[Pair], others: list[Pair]) -> None:
    shapes = {"A": "1", "B": "2"}
    excluded, expected = Exclusions.of_pairs(some, shapes), ascending(some)
    assert excluded.pairs == expected and len(excluded) == len(expected)
    assert excluded == Exclusions.of_pairs([(b, a) for a, b in reversed(some)], shapes)
    assert (excluded == Exclusions.of_pairs(others, shapes)) == (expected == ascending(others))
    assert Exclusions.from_json(excluded.to_json()) == (excluded if some else Exclusions())
    assert excluded.contains(*as_arrays(others)).tolist() == [bool(ascending([pair]) & expected) for pair in others]
    assert excluded.joined(*as_arrays(others)).pairs == expected | ascending(others)
    kept = excluded.without({"A"})
    assert kept.pairs == {pair for pair in expected if "A" not in (pair[0][0], pair[1][0])} and kept.shapes == {
        "B": "2"
    }
    assert excluded.face_count == len({key for pair in expected for key in pair})
    for name in ("A", "C\nrender", "D"):
        within = {(a[1], b[1]) for a, b in expected if a[0] == b[0] == name and a != b}
        assert set(map(tuple, excluded.within(name).tolist())) == within
    faces: dict[tuple[str, ...], set[FaceKey]] = {}
    for pair in expected:
        faces.setdefault(tuple(sorted(name.partition("\n")[0] for name, _ in pair)), set()).update(pair)
    assert {names: len(numbers) for names, numbers in excluded.faces.items()} == {k: len(v) for k, v in faces.items()}
    assert excluded.objects == {names for names in faces if names[0] != names[1]}
