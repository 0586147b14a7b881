# SPDX-License-Identifier: GPL-3.0-or-later
"""How close edits come to converged solutions: edits of real models, and their comparison."""
