# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene builders in plain NumPy: shapes, fixtures and their motion as data."""
