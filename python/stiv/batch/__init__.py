# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches of scenes: a job file, worker processes that may crash, and results that are complete or absent."""
