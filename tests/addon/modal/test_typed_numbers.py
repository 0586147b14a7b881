# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.event import Event
from stiv_addon.modal.expression import evaluate
from stiv_addon.modal.typed_numbers import MAX_DIGITS, TypedNumber, TypedValues, expression_character, typed_character


def number(keys: str) -> TypedNumber:
    typed = TypedNumber()
    for key in keys:
        typed = typed.typed(key)
    return typed


@pytest.mark.parametrize(
    ("keys", "value", "text"),
    [
        ("", None, ""),
        ("25", 25.0, "25"),
        ("2.5", 2.5, "2.5"),
        (".5", 0.5, ".5"),
        ("2.", 2.0, "2."),
        (".", None, "."),
        ("-", None, "-"),
        ("-3", -3.0, "-3"),
        ("3-", -3.0, "-3"),
        ("-3-", 3.0, "3"),
        ("1.2.3", 1.23, "1.23"),
        ("12\b", 1.0, "1"),
        ("12\b\b", None, ""),
        ("-1\b", None, "-"),
        ("-1\b\b", None, ""),
        ("4/", 0.25, "1/4"),
        ("4//", 4.0, "4"),
        ("/-2", -0.5, "-1/2"),
        ("2/\b\b", None, ""),
        ("\b", None, ""),
    ],
)
def test_keys_give_the_number(keys: str, value: float | None, text: str) -> None:
    typed = number(keys)
    assert (typed.value(), typed.text) == (value, text)
    assert typed.active == bool(text)


@given(st.text("0123456789.-\b", max_size=40))
def test_any_keys_give_a_number_that_python_reads(keys: str) -> None:
    typed = number(keys)
    assert len(typed.digits) <= MAX_DIGITS
    assert typed.value() is None or typed.value() == float(typed.text)


@given(st.text("0123456789.-/\b", max_size=40))
def test_repeated_backspace_deletes_everything(keys: str) -> None:
    assert not number(keys + "\b" * (MAX_DIGITS + 1)).active


@pytest.mark.parametrize(
    ("event", "character"),
    [
        (Event("FIVE", text="5"), "5"),
        (Event("FIVE"), "5"),
        (Event("NUMPAD_7"), "7"),
        (Event("NUMPAD_PERIOD"), "."),
        (Event("COMMA", text=","), "."),
        (Event("MINUS"), "-"),
        (Event("BACK_SPACE", text="\b"), "\b"),
        (Event("ONE", text="&"), "1"),  # the digit row of a French keyboard
        (Event("FIVE", modifiers=frozenset({"ctrl"}), text="5"), ""),
        (Event("SLASH", text="/"), "/"),
        (Event("NUMPAD_SLASH"), "/"),
        (Event("A", text="a"), ""),
        (Event("A", text="12"), ""),
    ],
)
def test_events_type_characters(event: Event, character: str) -> None:
    assert typed_character(event) == character


@pytest.mark.parametrize(
    ("event", "character"),
    [
        (Event("C", text="c"), "c"),
        (Event("C"), "c"),
        (Event("NUMPAD_PLUS"), "+"),
        (Event("SPACE", text=" "), " "),
        (Event("SEVEN", text="(", modifiers=frozenset({"shift"})), "("),
        (Event("EQUAL", text="="), "="),
        (Event("F5"), ""),
        (Event("LEFT_ALT"), ""),
        (Event("C", text="c", modifiers=frozenset({"ctrl"})), ""),
    ],
)
def test_expressions_accept_printable_characters(event: Event, character: str) -> None:
    assert expression_character(event) == character


def test_a_number_becomes_the_expression_that_is_shown() -> None:
    assert number("4-/").as_expression() == TypedNumber("-1/4", expression=True)
    assert TypedNumber("-1/4", expression=True).typed("-").digits == "-1/4-"


def test_the_reader_decides_the_value_of_a_number() -> None:
    assert number("4-/").value(lambda text: 10.0 * float(text)) == -1.0 / 40.0
    with pytest.raises(ValueError, match="1/0"):
        number("0/").value()


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
def test_keys_give_the_numbers_of_components(keys: str, expected: list, text: str) -> None:
    typed = after(keys)
    assert values(typed) == pytest.approx(expected)
    assert typed.text(3) == text
    assert typed.active == any(value is not None for value in expected)


def test_fewer_components_keep_the_first_numbers() -> None:
    typed = after("1\t2\t3").limited(2)
    assert values(typed) == [1, 2, None] and typed.index == 1
    assert after("1\t2", count=2).moved_on(2).index == 0
