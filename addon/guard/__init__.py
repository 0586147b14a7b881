# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: the result of any tool becomes the goal of an edit from the last clear state.

decision: what to do when, without bpy; watcher: handlers and timer; correction: read, solve, write; undo_steps: one
step for tool and correction; alerts: messages to the user; problem: their texts.
"""
