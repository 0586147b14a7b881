# SPDX-License-Identifier: GPL-3.0-or-later
"""The modeling sessions of the paper as plain data: surfaces, deformations and edits."""
