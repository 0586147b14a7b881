# SPDX-License-Identifier: GPL-3.0-or-later
"""The modeling sessions that the paper shows, as plain data: surfaces, deformations, and edit after edit."""
