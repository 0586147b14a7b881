# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m stiv.command_line`: the command without its installed script."""

from stiv.command_line.program import main

main()
