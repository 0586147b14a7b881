# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: what any tool did becomes the goal of an edit from the last accepted state.

decision: what to do when, without bpy; watcher: handlers and the timer; correction: read, solve, write; undo_steps:
one step for tool and correction; alerts: what the user sees of it.
"""
