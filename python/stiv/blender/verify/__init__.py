# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests what Blender evaluates: scenes, animations and the result of edits."""
