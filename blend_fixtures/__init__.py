# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes made by script: builders in plain NumPy (`scenes`), the .blend files written from them, and the demo."""
