# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON schemas of the files that STIV reads and writes."""
