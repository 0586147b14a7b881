# SPDX-License-Identifier: GPL-3.0-or-later
"""What an edit changes: the controls of cages, handles, lattices and rigid objects, and how they are written."""
