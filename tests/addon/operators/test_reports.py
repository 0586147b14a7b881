# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages fit Blender's status bar in every language, with the longest names."""

from types import SimpleNamespace
from typing import Any

import pytest

from tests.addon.test_errors import shown

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv.blender.scene import exclusions  # noqa: E402
from stiv_addon.intersection_texts import LENGTH, as_messages  # noqa: E402
from stiv_addon.modal.header_texts import naming, result_text  # noqa: E402
from stiv_addon.operators import reports  # noqa: E402
from stiv_addon.translations import errors  # noqa: E402

LONGEST = 63  # characters of a name in Blender
LANGUAGES = sorted(errors.CATALOGUES)


def long_names(count: int) -> list[str]:
    return [(f"{number} " + "Long Name " * 9)[:LONGEST] for number in range(count)]


def filled(template: str) -> list[str]:
    """The template with the longest names, with and without the name of an object before it."""
    text = template.format(*long_names(template.count("{}")))
    return [text, f"{'O' * LONGEST}: {text}"]


@pytest.mark.parametrize("template", sorted(shown() | errors.CATALOGUES["de_DE"].keys()))
def test_every_message_fits_with_the_longest_names(template: str) -> None:
    ending = template.rpartition("}")[2]
    for text in filled(template):
        message = reports.message_text(text)
        assert len(message) <= LENGTH
        if len(template) <= 67:  # others do not leave room for a name
            assert message.endswith(ending), message


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_translated_message_fits(language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    catalogue = errors.CATALOGUES[language]
    monkeypatch.setattr(reports, "translate", lambda english: catalogue.get(english, english))
    for text in [text for template in catalogue for text in filled(template)]:
        message = reports.message_text(text)
        assert len(message) <= LENGTH and message != text, message


def test_messages_that_name_several_objects_fit() -> None:
    first, second = long_names(2)
    fit = reports.stiv_blender.fit_message
    for count in (1, 2, 3, 40):
        assert len(result_text("blocked", long_names(count), str, fit)) <= LENGTH
        assert len(naming("put {} at the nearest free place", str, fit, long_names(count))) <= LENGTH
        assert len(naming("corrected {}, blocked by {}", str, fit, long_names(count), long_names(count))) <= LENGTH
    assert len(exclusions.intersection_text(first, second, 123456, ", may only part")) <= LENGTH
    assert len(exclusions.loose_geometry_text(first, second)) <= LENGTH
    assert result_text("blocked", ["Wall", "Floor"], str, fit) == "blocked by Wall, Floor"


@pytest.fixture
def reported(monkeypatch: pytest.MonkeyPatch) -> tuple[Any, list[tuple[str, str]]]:
    """An operator, and what it reports."""
    messages: list[tuple[str, str]] = []
    operator = SimpleNamespace(report=lambda kinds, text: messages.append((*kinds, text)))
    return operator, messages


def test_texts_that_do_not_fit_one_message_are_reported_in_several(reported: Any) -> None:
    operator, messages = reported
    reports.report_outcome(operator, "deflected", "", ["x" * 60, "y" * 30])
    assert messages == [("WARNING", "deflected; " + "x" * 60), ("WARNING", "y" * 30)]
    assert as_messages([]) == []


def test_an_outcome_without_exceptions_is_information(reported: Any) -> None:
    operator, messages = reported
    reports.report_outcome(operator, "deflected", "")
    reports.report_outcome(operator, "", "")
    assert messages == [("INFO", "deflected")]


@pytest.mark.parametrize("prefix", ["Error", "Fehler"])
def test_the_error_of_a_nested_operator_is_remembered_once(reported: Any, prefix: str) -> None:
    operator, messages = reported
    reports.last_messages.clear()
    reports.say(operator, "ERROR", "Cube: no surface")
    reports.report_raised(operator, RuntimeError(f"{prefix}: Cube: no surface\n"))
    assert messages == [("ERROR", "Cube: no surface")] * 2  # Blender shows that of the outer operator
    assert list(reports.last_messages) == ["SimpleNamespace: ERROR: Cube: no surface"]


def test_the_error_of_a_nested_operator_of_blender_is_remembered(reported: Any) -> None:
    operator, messages = reported
    reports.last_messages.clear()
    reports.say(operator, "INFO", "deflected")
    reports.report_raised(operator, RuntimeError("Error: no view\n"))
    assert messages[1:] == [("ERROR", "no view")]
    assert list(reports.last_messages)[1:] == ["SimpleNamespace: ERROR: no view"]
