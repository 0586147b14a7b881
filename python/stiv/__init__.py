# SPDX-License-Identifier: GPL-3.0-or-later
"""Interference-aware geometric modeling: surfaces that do not go through each other."""
