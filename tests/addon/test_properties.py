# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices and defaults of the add-on, which registers without the package `stiv`, are those of the package."""

import pytest

import stiv
from stiv import choices

bpy = pytest.importorskip("bpy")

from stiv.blender import EditSettings  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

CHOICES = {
    ("StivSceneSettings", "responders"): choices.RESPONDERS,
    ("StivSceneSettings", "object_response"): choices.OBJECT_RESPONSES,
    ("StivSceneSettings", "guard"): choices.GUARDS,
    ("StivSceneSettings", "constraints"): tuple(stiv._native.ConstraintKind.__members__),
    ("StivObjectSettings", "role"): choices.ROLES,
    ("StivObjectSettings", "deformation"): choices.DEFORMATIONS,
    ("StivObjectSettings", "rest"): choices.RESTS,
    ("StivLoop", "boundary"): choices.BOUNDARIES,
}


def group(name: str) -> type:
    return next(each for each in bpy.types.PropertyGroup.__subclasses__() if each.__name__ == name)


@pytest.mark.parametrize(("owner", "name"), CHOICES)
def test_the_choices_of_the_interface_are_those_of_the_package(owner: str, name: str) -> None:
    chosen = group(owner).bl_rna.properties[name]
    assert tuple(item.identifier for item in chosen.enum_items) == CHOICES[owner, name]
    assert chosen.default == CHOICES[owner, name][0]


@pytest.mark.parametrize("name", ["constraints", "responders", "object_response", "guard"])
def test_the_package_chooses_the_same_by_default(name: str) -> None:
    assert CHOICES["StivSceneSettings", name][0] == getattr(EditSettings, name)


@pytest.mark.parametrize("name", ["separation", "smoothness", "tight", "interference"])
def test_the_defaults_of_the_interface_are_those_of_the_package(name: str) -> None:
    default = group("StivSceneSettings").bl_rna.properties[name].default
    assert default == pytest.approx(getattr(EditSettings, name), rel=1e-6)


def test_a_drag_cycles_through_the_responders() -> None:
    from stiv_addon.modal.request import RESPONDERS

    assert RESPONDERS == choices.RESPONDERS
