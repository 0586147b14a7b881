# SPDX-License-Identifier: GPL-3.0-or-later
"""For newcomers: example scenes, presets, the guide, and a report for an issue."""

from . import examples, presets, report

CLASSES = (*examples.CLASSES, *presets.CLASSES, *report.CLASSES)
