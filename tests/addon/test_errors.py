# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the package appear in the language of the interface: templates are found, translated and filled in."""

import re
import warnings
from pathlib import Path
from typing import Any

import pytest

from tools import error_messages

bpy = pytest.importorskip("bpy")

import stiv  # noqa: E402
from stiv.blender.controls.editable import check_placement  # noqa: E402
from stiv.blender.scene.modifier_stack import modifier_error  # noqa: E402
from stiv_addon.translations import errors  # noqa: E402

LANGUAGES = sorted(errors.CATALOGUES)
# Texts change with the code. A few without a translation stay English, so they are only listed.
ENOUGH = 0.9
FOR_SCRIPTS = re.compile(r"^\w+: \{\}|--|^the settings name it|^there is no (object|scene)")
BY_HAND = {  # of the compiled core, or composed of several parts
    "1 loose edge or vertex touches it and is not tested", "{} loose edges or vertices touch it and are not tested",
    "1 triangle has no area", "1 vertex follows", "back to the last state without intersections: {}",
    "bodies that may overlap would overlap more than at the start", "collisions stay off: {}",
    "loose geometry cuts {}; use Mesh > Clean Up > Delete Loose",
    "control {} is too large for single precision", "separation {}: the least that can be kept here is {}, because "
    "coordinates reach {} and are stored in single precision; use at least that, 0 for automatic, or move the scene "
    "nearer to the origin", "the faces have changed, so their exclusions are dropped",
    "the start already intersects: {}", "1 pair of faces cut each other{}", "{} pairs of faces cut each other{}",
    "the system is singular to rounding; add handles or fixed vertices",
    "{} cuts {}, {} faces, may only part", "{} cuts {}, {} faces{}",
    "{} faces at torn seams cut each other; use Merge by Distance",
    "{} cuts or touches itself, {} faces, left as it is",
    "{} intersects itself, {} faces, left as it is", "{} more objects intersect themselves, left as they are",
    "{} more pairs of objects cut each other, may only part", "{} triangles have no area", "{} vertices follow",
}  # fmt: skip


def shown() -> set[str]:
    return {text for text in error_messages.templates() if not FOR_SCRIPTS.search(text)}


@pytest.mark.parametrize("language", LANGUAGES)
def test_nearly_all_messages_have_a_translation_and_the_others_are_listed(language: str) -> None:
    known, catalogue = shown(), errors.CATALOGUES[language]
    missing, old = sorted(known - catalogue.keys()), sorted(catalogue.keys() - known - BY_HAND)
    if missing or old:
        warnings.warn(f"{language}: not translated {missing}; not in the sources {old}", stacklevel=1)
    assert len(known) > 70
    assert len(known & catalogue.keys()) >= ENOUGH * len(known), missing
    assert len(old) <= (1 - ENOUGH) * len(catalogue), old


def test_messages_composed_of_several_parts_are_in_the_sources() -> None:
    root = Path(__file__).resolve().parents[2]
    paths = [*(root / "python/stiv/blender").rglob("*.py"), *(root / "native/src").rglob("*.cpp")]
    sources = "\n".join(path.read_text(encoding="utf-8") for path in paths)
    texts = re.sub(r'"\s*\n\s*f?"', "", sources)  # texts that continue on the next line
    for template in BY_HAND:
        for fixed in filter(None, (part.strip(" ,:") for part in template.split("{}"))):
            words = fixed.split()
            halves = [(words[:end], words[end:]) for end in range(len(words))]  # of one text or two
            assert any(all(" ".join(half) in texts for half in each) for each in halves), fixed


def test_all_languages_have_the_same_messages() -> None:
    first, *others = [catalogue.keys() for catalogue in errors.CATALOGUES.values()]
    assert all(each == first for each in others)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_translation_keeps_the_parts_that_vary(language: str) -> None:
    for english, text in errors.CATALOGUES[language].items():
        assert text != english and text[-1] not in ".。"
        names = [f"Näme {number}" for number in range(english.count("{}"))]
        filled = errors.in_language(f"Würfel: {english.format(*names)}", errors.CATALOGUES[language].get)
        assert all(filled.count(name) == 1 for name in names), filled
        assert "Würfel" in filled and filled != f"Würfel: {english.format(*names)}", filled


def in_german(text: object) -> str:
    return errors.in_language(str(text), lambda english: errors.CATALOGUES["de_DE"].get(english, english))


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("Cube: its scale is zero; change it", "Cube: die Skalierung ist null; ändern"),
        ("A: B: its scale is zero; change it", "A: B: die Skalierung ist null; ändern"),
        ('Cube: shape key "Smile" is locked; unlock it', 'Cube: Formschlüssel "Smile" ist gesperrt; entsperren'),
        ('Cube: Armature "Arm" is not supported; apply it', 'Cube: Armature "Arm" wird nicht unterstützt; anwenden'),
        ('Cube: Lattice "L 2" uses "L" again; apply it', 'Cube: Lattice "L 2" verwendet "L" noch einmal; anwenden'),
        ("Suzanne cuts Spot, 629 faces", "Suzanne schneidet Spot, 629 Flächen"),
        ("Cube is gone", "Cube ist nicht mehr da"),
        ("a text that nobody knows", "a text that nobody knows"),
        ("", ""),
    ],
)
def test_messages_are_found_in_texts(english: str, german: str) -> None:
    assert in_german(english) == german


def test_no_name_disturbs_the_search() -> None:
    name = '{0} "x": its scale is zero; {}'
    assert in_german(f"{name}: its transform is locked; unlock it") == (
        f"{name}: die Transformation ist gesperrt; entsperren"
    )


def test_real_refusals_are_translated(cube: Any) -> None:
    cube.scale.x = 0.0
    bpy.context.view_layer.update()
    with pytest.raises(stiv.InputError) as refused:
        check_placement(cube)
    assert in_german(refused.value) == "Cube: die Skalierung ist null; ändern"
    modifier = cube.modifiers.new("Weich", "CORRECTIVE_SMOOTH")
    error = modifier_error(cube, modifier.name, "unsupported")
    assert in_german(error).endswith('"Weich" wird nicht unterstützt; anwenden')


@pytest.fixture
def cube() -> Any:
    bpy.ops.wm.read_factory_settings()
    return bpy.data.objects["Cube"]
