# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `stiv`: one subcommand a file; `program` runs it."""
