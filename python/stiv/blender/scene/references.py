# SPDX-License-Identifier: GPL-3.0-or-later
"""Names for objects that outlive undo: Blender's own references do not."""

from dataclasses import dataclass

import bpy

from stiv.blender.scene.errors import SceneChangedError


@dataclass(frozen=True)
class ObjectReference:
    """An object by name and by the number it keeps while the file is open (through renaming and undo)."""

    name: str
    session_uid: int

    @staticmethod
    def of(ob: bpy.types.Object) -> "ObjectReference":
        """Reference to an object, or to the original of an evaluated one."""
        original = ob.original
        return ObjectReference(original.name, original.session_uid)

    def find(self) -> bpy.types.Object:
        """The object as it is now. Raises SceneChangedError when it is gone."""
        ob = bpy.data.objects.get(self.name)
        if ob is not None and ob.session_uid == self.session_uid:
            return ob
        for other in bpy.data.objects:
            if other.session_uid == self.session_uid:
                return other
        raise SceneChangedError(f'object "{self.name}" is gone')

    def find_in_mode(self, mode: str) -> bpy.types.Object:
        """The object, still in this mode ("OBJECT", "EDIT"). Raises SceneChangedError."""
        ob = self.find()
        if ob.mode != mode:
            raise SceneChangedError(f'object "{self.name}" has left {mode.title()} Mode')
        return ob
