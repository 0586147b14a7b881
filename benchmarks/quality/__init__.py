# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares edits of real models with converged solutions."""
