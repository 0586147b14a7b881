# SPDX-License-Identifier: GPL-3.0-or-later
"""Move, rotate and scale, by values or by a drag."""
