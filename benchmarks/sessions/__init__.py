# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements of whole editing sessions, run by `stiv bench`: the paper's table, profiles, growth and races."""
