# SPDX-License-Identifier: GPL-3.0-or-later
"""One edit of the open scene, from the snapshot at its start to the tested state in Blender."""
