# SPDX-License-Identifier: GPL-3.0-or-later
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.expression import MAX_LENGTH, evaluate

LENGTHS = {"m": 1.0, "cm": 0.01, "ft": 0.3048, "'": 0.3048, '"': 0.0254, "": 0.1}


def value(text: str) -> float:
    return evaluate(text, LENGTHS.get)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2", 0.2),
        ("2+3*4", 1.4),
        ("(2+3)*4", 2.0),
        ("-2**2", -0.4),
        ("2**-1", 0.05),
        ("2^3^2", 51.2),
        ("10/4/5", 0.05),
        ("1-2-3", -0.4),
        ("--2", 0.2),
        ("pi", 0.1 * math.pi),
        ("5cm", 0.05),
        ("5 cm", 0.05),
        ("1m 20cm", 1.2),
        ("6'2\"", 6 * 0.3048 + 2 * 0.0254),
        ("3*20cm", 0.6),
        ("(1m + 50cm) / 2", 0.75),
        (" .5m ", 0.5),
    ],
)
def test_expressions_have_their_value(text: str, expected: float) -> None:
    assert value(text) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    ["", " ", "+", "2+", "2*/3", "(2", "2)", "()", "1/0", "5 xx", "abc", "pi pi", "2..3", "9**9**9", "(-1)**0.5"]
    + [
        "open",
        "__import__('os')",
        "exit()",
        "2;3",
        "1e5",
        "x=1",
        "1" * (MAX_LENGTH + 1),
        "[1]",
        "0x10",
        "1_0",
        "2 m m",
    ],
)
def test_invalid_expressions_are_rejected(text: str) -> None:
    with pytest.raises(ValueError):
        value(text)


@given(st.text(max_size=MAX_LENGTH + 5))
def test_any_text_gives_a_finite_number_or_a_refusal(text: str) -> None:
    try:
        assert math.isfinite(value(text))
    except ValueError as refusal:
        assert str(refusal)


NUMBERS = st.integers(0, 99).map(str)
SUMS = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*"), inner).map("".join),
        inner.map("({})".format),
        inner.map("-({})".format),
    ),
    max_leaves=8,
)


@given(SUMS)
def test_plain_arithmetic_is_that_of_python(text: str) -> None:
    if len(text) <= MAX_LENGTH:
        assert evaluate(text, {"": 1.0}.get) == pytest.approx(eval(text))
