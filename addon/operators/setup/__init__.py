# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists in the settings of objects and scenes: handles, Loop subdivision, pair distances."""
