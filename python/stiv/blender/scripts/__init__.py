# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts and commands need: files, selections and edit scripts."""
