# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal part of a transform: events in, state and effects out. Knows neither Blender nor geometry."""
