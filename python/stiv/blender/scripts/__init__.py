# SPDX-License-Identifier: GPL-3.0-or-later
"""Files, selections, edit scripts and registration, for scripts and commands."""
