# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: transform, layout, check, repair and setup, one in each file.

Imports none of them: the guard uses `reports`, `running` and `window_io`, and some operators use the guard.
"""
