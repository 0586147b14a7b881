# SPDX-License-Identifier: GPL-3.0-or-later
"""What has controls in an edit."""

from dataclasses import dataclass

from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class Mover:
    """An object with controls: role "cage", "soft", "lattice" or "rigid"; `selected` if the goal moves it."""

    reference: ObjectReference
    role: str
    selected: bool
