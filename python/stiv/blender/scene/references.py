# SPDX-License-Identifier: GPL-3.0-or-later
"""References to objects that survive undo, which invalidates Blender's own."""

from dataclasses import dataclass

import bpy


class SceneChangedError(RuntimeError):
    """An object of a running edit was removed, or its mode or size changed; the edit has to be cancelled."""


def type_name(ob: bpy.types.Object) -> str:
    """The object's type as Blender's menus name it, in lower case."""
    name: str = ob.bl_rna.properties["type"].enum_items[ob.type].name
    return name.lower()


def modifier_title(modifier: bpy.types.Modifier) -> str:
    """The modifier's type as Blender's menu names it, and its own name."""
    return f'{modifier.bl_rna.properties["type"].enum_items[modifier.type].name} "{modifier.name}"'


@dataclass(frozen=True)
class ObjectReference:
    """An object by name and session number, which renaming and undo preserve."""

    name: str
    session_uid: int

    @staticmethod
    def of(ob: bpy.types.Object) -> "ObjectReference":
        """Reference to an object, or to the original of an evaluated object."""
        original = ob.original
        return ObjectReference(original.name, original.session_uid)

    def find(self) -> bpy.types.Object:
        """The object at present. Raises SceneChangedError if it was removed."""
        ob = bpy.data.objects.get(self.name)
        if ob is not None and ob.session_uid == self.session_uid:
            return ob
        for other in bpy.data.objects:
            if other.session_uid == self.session_uid:
                return other
        raise SceneChangedError(f"{self.name} is gone")

    def find_in_mode(self, mode: str) -> bpy.types.Object:
        """The object, if it is still in this mode ("OBJECT", "EDIT"). Raises SceneChangedError."""
        ob = self.find()
        if ob.mode != mode:
            raise SceneChangedError(f"{self.name} has left {mode.title()} Mode")
        return ob
