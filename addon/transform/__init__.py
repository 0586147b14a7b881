# SPDX-License-Identifier: GPL-3.0-or-later
"""From a drag to a 4x4 world matrix: translation, rotation, scaling. NumPy only."""
