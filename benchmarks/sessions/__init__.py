# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements of whole editing sessions: the paper's table, profiles, growth, a race; no bpy."""
