# SPDX-License-Identifier: GPL-3.0-or-later
"""Many scenes at once: a job file, worker processes that may die, results that are whole or not there."""
