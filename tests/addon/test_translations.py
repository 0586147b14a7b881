# SPDX-License-Identifier: GPL-3.0-or-later
"""Sources and catalogues hold the same texts, and Blender finds them."""

import re
from collections.abc import Iterator
from typing import Any

import pytest

from tools import interface_messages

bpy = pytest.importorskip("bpy")

from stiv_addon import translations  # noqa: E402
from stiv_addon.registration import CLASSES  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

SAME_IN_GERMAN = {"Animation", "Global", "Layout", "Rest", "Threads", "Vertices"}


@pytest.fixture
def language() -> Iterator[Any]:
    view = bpy.context.preferences.view
    before = view.language
    yield view
    view.language = before


@pytest.mark.parametrize("name", sorted(translations.CATALOGUES))
def test_a_catalogue_translates_every_message_of_the_sources_and_no_other(name: str) -> None:
    known, catalogue = interface_messages.messages(), translations.CATALOGUES[name]
    assert known - catalogue.keys() == set(), "to be translated; see tools/interface_messages.py"
    assert catalogue.keys() - known == set(), "not in the sources any more"


@pytest.mark.parametrize("name", sorted(translations.CATALOGUES))
def test_a_translation_is_another_text_that_ends_like_the_original(name: str) -> None:
    for english, text in translations.CATALOGUES[name].items():
        assert text.strip() == text and text
        assert text != english or (name == "de_DE" and english in SAME_IN_GERMAN), english
        assert (english[-1] == ".") == (text[-1] in ".。"), english
        assert re.findall(r"\d+\.?\d*", english) == re.findall(r"\d+\.?\d*", text) or "ten" in english, english


def test_registered_texts_are_those_of_the_sources() -> None:
    known = interface_messages.messages()
    for cls in CLASSES:
        assert getattr(cls, "bl_label", None) in known | {None}
        if issubclass(cls, bpy.types.Operator):
            tooltip = getattr(bpy.ops.stiv, cls.bl_idname.partition(".")[2]).get_rna_type().description
            assert tooltip in known, cls
        own = set(cls.bl_rna.properties.keys()) - set(cls.bl_rna.base.properties.keys())
        for prop in (cls.bl_rna.properties[name] for name in own if not name.startswith("bl_")):
            assert prop.name in known | {"", prop.identifier}, (cls, prop.identifier)
            assert not prop.description or prop.description in known, (cls, prop.identifier)


def labels() -> Iterator[str]:
    """Every label of an operator, a panel, a menu, a property and a choice of a property."""
    for cls in CLASSES:
        yield getattr(cls, "bl_label", "")
        owner = (
            getattr(bpy.ops.stiv, cls.bl_idname.partition(".")[2]).get_rna_type() if is_operator(cls) else cls.bl_rna
        )
        for prop in owner.properties:
            if not (
                prop.is_hidden or prop.identifier.startswith("bl_") or prop.identifier in cls.bl_rna.base.properties
            ):
                yield prop.name
                yield from (choice.name for choice in getattr(prop, "enum_items", ()))


def is_operator(cls: Any) -> bool:
    return issubclass(cls, bpy.types.Operator)


SMALL = {"and", "for", "in", "into", "of", "on", "out", "to"}
LONG = {"Show Overlay on Startup", "Slide out of Axis"}


@pytest.mark.parametrize("group", ["transform", "check", "repair"])
def test_a_search_for_collision_finds_the_operators(group: str) -> None:
    found = [cls.bl_label for cls in CLASSES if is_operator(cls) and f".operators.{group}." in cls.__module__]
    assert found and all("Collision" in label for label in found), found


def test_labels_are_short_titles_without_articles() -> None:
    for label in filter(None, labels()):
        words = label.split()
        assert len(words) <= 3 or label in LONG, label
        assert not {"a", "an", "the"} & {word.lower() for word in words}, label
        assert all(word[0].isupper() or word in SMALL for word in words if word[0].isalpha()), label


def test_no_text_ends_with_a_full_stop_and_none_is_longer_than_a_line() -> None:
    for text in interface_messages.messages():
        assert not text.endswith("."), text
        assert len(text) <= 80, text


@pytest.mark.parametrize(("code", "expected"), [("de_DE", "Verformung"), ("ja_JP", "変形方法")])
def test_blender_shows_the_language_that_is_chosen(language: Any, code: str, expected: str) -> None:
    try:
        language.language = code
    except TypeError:
        pytest.skip(f"this Blender module has no {code}")
    language.use_translate_interface = True
    if bpy.app.translations.pgettext_iface("Object") == "Object":
        pytest.skip("this Blender module was built without translations")
    assert bpy.app.translations.pgettext_iface("Deformation") == expected
    assert bpy.app.translations.pgettext_iface("Collision Move", "Operator") != "Collision Move"
