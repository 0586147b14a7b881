# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: corrects what other tools made of the scene."""
