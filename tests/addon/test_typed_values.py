# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from stiv_addon.modal.expression import evaluate
from stiv_addon.modal.typed_values import TypedValues


def after(keys: str, count: int = 3) -> TypedValues:
    """Tab is written as a tabulator, and "=" begins an expression."""
    typed = TypedValues()
    for key in keys:
        match key:
            case "\t":
                typed = typed.moved_on(count)
            case "=":
                typed = typed.as_expression()
            case _:
                typed = typed.typed(key)
    return typed


def values(typed: TypedValues) -> list[float | None]:
    return [typed.value(i, lambda text: evaluate(text, {"": 1.0, "cm": 0.01}.get)) for i in range(3)]


@pytest.mark.parametrize(
    ("keys", "expected", "text"),
    [
        ("", [None, None, None], "[|]"),
        ("1\t2\t3", [1, 2, 3], "[1] [2] [3|]"),
        ("1\t\t3", [1, None, 3], "[1] [] [3|]"),
        ("1\t2\t3\t4", [14, 2, 3], "[14|] [2] [3]"),
        ("\t5-", [None, -5, None], "[] [-5|]"),
        ("1\t\b\b", [None, None, None], "[|]"),
        ("=2*3\t4+1", [6, 5, None], "[2*3] [4+1|]"),
        ("2\t3=-1", [2, 2, None], "[2] [3-1|]"),
        ("=5cm", [0.05, None, None], "[5cm|]"),
    ],
)
def test_keys_give_numbers(keys: str, expected: list, text: str) -> None:
    typed = after(keys)
    assert values(typed) == pytest.approx(expected)
    assert typed.text(3) == text
    assert typed.active == any(value is not None for value in expected)


def test_fewer_components_keep_the_first_numbers() -> None:
    typed = after("1\t2\t3").limited(2)
    assert values(typed) == [1, 2, None] and typed.index == 1
    assert after("1\t2", count=2).moved_on(2).index == 0
