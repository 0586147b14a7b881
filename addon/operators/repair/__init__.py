# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways out of a scene that intersects: repair, contraction, expansion, exclusions, the last clear state."""
