# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction, expansion and repair of selected meshes."""
