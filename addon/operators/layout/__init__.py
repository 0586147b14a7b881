# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that lay out objects: drop, settle into contact, place, push apart, fit into."""
