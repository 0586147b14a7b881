# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of an object's and a scene's settings: handles, Loop subdivision, distances of pairs."""
