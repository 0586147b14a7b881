# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes built by scripts: builders in plain NumPy (`scenes`), the .blend files written from them, and the demo."""
