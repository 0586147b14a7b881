# SPDX-License-Identifier: GPL-3.0-or-later
"""The controls of cages, handles, lattices and rigid objects, and their writers."""
